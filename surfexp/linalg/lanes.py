"""Eight numbers in a register: what compiled kernels on blocks of eight columns are written with.

A compiler keeps the running sums of a loop over a small array in memory. A value of this type stays in a vector register
(one of AVX-512, two of AVX2, four of NEON), which makes triangular solves with eight right-hand sides twice as fast.
"""

from __future__ import annotations

from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.extending import intrinsic, models, register_model

LANES = 8
VECTOR = ir.VectorType(ir.DoubleType(), LANES)
CONTRACT = ("contract",)


class LanesType(types.Type):
    """Type of eight float64 in compiled code; Python never sees a value of it."""

    def __init__(self) -> None:
        super().__init__("Lanes")


LANES_TYPE = LanesType()


@register_model(LanesType)
class LanesModel(models.PrimitiveModel):
    """A vector of LLVM."""

    def __init__(self, manager: Any, numba_type: Any) -> None:
        super().__init__(manager, numba_type, VECTOR)


@intrinsic
def zero(typing: Any) -> Any:
    """Return eight zeros."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return ir.Constant(VECTOR, None)

    return LANES_TYPE(), generate


@intrinsic
def load(typing: Any, block: Any, row: Any) -> Any:
    """Return row `row` of a C-ordered (n, 8) float64 block; the index is not checked."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_address(context, builder, signature, arguments), align=8)

    _check_order(block)
    return LANES_TYPE(block, types.intp), generate


@intrinsic
def store(typing: Any, block: Any, row: Any, lanes: Any) -> Any:
    """Write eight numbers to row `row` of a C-ordered (n, 8) float64 block; the index is not checked."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store(arguments[2], _address(context, builder, signature, arguments), align=8)
        return context.get_dummy_value()

    _check_order(block)
    return types.void(block, types.intp, LANES_TYPE), generate


@intrinsic
def load_part(typing: Any, matrix: Any, row: Any, column: Any) -> Any:
    """Return the eight entries from (row, column) on of a float64 matrix whose rows are contiguous; nothing is checked."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load(_address_in_row(context, builder, signature, arguments), align=8)

    return LANES_TYPE(matrix, types.intp, types.intp), generate


@intrinsic
def store_part(typing: Any, matrix: Any, row: Any, column: Any, lanes: Any) -> Any:
    """Write eight entries from (row, column) on of a float64 matrix whose rows are contiguous; nothing is checked."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store(arguments[3], _address_in_row(context, builder, signature, arguments), align=8)
        return context.get_dummy_value()

    return types.void(matrix, types.intp, types.intp, LANES_TYPE), generate


@intrinsic
def plus_product(typing: Any, lanes: Any, factor: Any, others: Any) -> Any:
    """Return lanes + factor others."""
    return _with_product("fadd")


@intrinsic
def minus_product(typing: Any, lanes: Any, factor: Any, others: Any) -> Any:
    """Return lanes - factor others."""
    return _with_product("fsub")


@intrinsic
def plus_lanes(typing: Any, lanes: Any, factors: Any, others: Any) -> Any:
    """Return lanes + factors others, number by number."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        product = builder.fmul(arguments[1], arguments[2], flags=CONTRACT)
        return builder.fadd(arguments[0], product, flags=CONTRACT)

    return LANES_TYPE(LANES_TYPE, LANES_TYPE, LANES_TYPE), generate


@intrinsic
def total(typing: Any, lanes: Any) -> Any:
    """Return the sum of the eight numbers, by halves."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        lanes, undefined = arguments[0], ir.Constant(VECTOR, ir.Undefined)
        half = LANES // 2
        while half:
            other = [lane + half if lane < half else 0 for lane in range(LANES)]
            mask = ir.Constant(ir.VectorType(ir.IntType(32), LANES), other)
            lanes = builder.fadd(lanes, builder.shuffle_vector(lanes, undefined, mask))
            half //= 2
        return builder.extract_element(lanes, ir.Constant(ir.IntType(32), 0))

    return types.float64(LANES_TYPE), generate


@intrinsic
def quotient(typing: Any, lanes: Any, divisor: Any) -> Any:
    """Return lanes / divisor."""

    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.fdiv(arguments[0], _spread(builder, arguments[1]))

    return LANES_TYPE(LANES_TYPE, types.float64), generate


def _with_product(operation: str) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        product = builder.fmul(_spread(builder, arguments[1]), arguments[2], flags=CONTRACT)
        return getattr(builder, operation)(arguments[0], product, flags=CONTRACT)

    return LANES_TYPE(LANES_TYPE, types.float64, LANES_TYPE), generate


def _check_order(block: Any) -> None:
    if block.layout != "C" or block.dtype != types.float64:
        raise TypingError(f"a block of eight lanes must be a C-ordered float64 array, not {block}")


def _address(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    array = context.make_array(signature.args[0])(context, builder, arguments[0])
    entry = builder.mul(arguments[1], context.get_constant(types.intp, LANES))
    return builder.bitcast(builder.gep(array.data, [entry]), VECTOR.as_pointer())


def _address_in_row(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    array = context.make_array(signature.args[0])(context, builder, arguments[0])
    size = context.get_constant(types.intp, 8)
    step = cgutils.unpack_tuple(builder, array.strides, 2)[0]
    offset = builder.add(builder.mul(arguments[1], step), builder.mul(arguments[2], size))
    start = builder.bitcast(array.data, ir.IntType(8).as_pointer())
    return builder.bitcast(builder.gep(start, [offset]), VECTOR.as_pointer())


def _spread(builder: Any, number: Any) -> Any:
    undefined = ir.Constant(VECTOR, ir.Undefined)
    first = builder.insert_element(undefined, number, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(first, undefined, ir.Constant(ir.VectorType(ir.IntType(32), LANES), [0] * LANES))
