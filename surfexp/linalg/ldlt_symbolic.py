"""The symbolic phase of a sparse LDL^T: elimination tree, supernodes, and the rows of every supernode."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy.sparse import csr_array, sparray

from surfexp.contract.arrays import Integers
from surfexp.linalg.lanes import LANES
from surfexp.linalg.ldlt_ordering import nested_dissection


@dataclass(frozen=True, eq=False)
class SymbolicFactor:
    """What the factors of all matrices of one pattern have in common.

    A supernode is a run of columns with (nearly) the same rows; its part of L is stored as a dense panel: the square
    diagonal block row by row, then the rows below it in groups of eight, each group column by column.

    Parameters
    ----------
    permutation : (n,) int64
        Row of the matrix that is eliminated first, second, ...
    columns : (s + 1,) int64
        First column of each supernode.
    row_starts : (s + 1,) int64
        Where in `rows` the rows below the diagonal block of a supernode begin.
    rows : int64 array
        Those rows, sorted in each supernode.
    parents : (s,) int64
        Supernode that takes the update of each one; -1 at a root.
    panels : (s + 1,) int64
        Where in the factor the panel of each supernode begins.
    """

    permutation: Integers
    columns: Integers
    row_starts: Integers
    rows: Integers
    parents: Integers
    panels: Integers

    @property
    def size(self) -> int:
        """Number of rows of the matrix."""
        return len(self.permutation)

    @property
    def entries(self) -> int:
        """Number of stored entries of the factor, explicit zeros included."""
        return int(self.panels[-1])


def analyse(matrix: sparray) -> SymbolicFactor:
    """Find a good elimination order for the pattern of a symmetric matrix and where its factor has entries.

    Parameters
    ----------
    matrix : (n, n) sparse array
        Only its pattern is used, and counts as symmetric: entry (i, j) brings (j, i). Explicit zeros belong to it.

    Raises
    ------
    ValueError
        If the matrix is not square or has no rows.
    """
    if matrix.shape[0] != matrix.shape[1] or not matrix.shape[0]:
        raise ValueError(f"matrix has shape {matrix.shape}, a factorisation needs a square one of at least 1 x 1")
    pattern = both_triangles(csr_array(matrix))
    order = nested_dissection(pattern.indptr, pattern.indices)
    order = order[_postorder(_elimination_tree(*_permuted_pattern(pattern, order)))]
    indptr, indices = _permuted_pattern(pattern, order)
    tree = _elimination_tree(indptr, indices)
    counts = _column_counts(indptr, indices, tree)
    columns = _supernodes(tree, counts)
    row_starts, rows, parents = _supernode_rows(indptr, indices, columns, int(counts.sum()))
    rows = _sorted_in_each(row_starts, rows, matrix.shape[0])
    widths = np.diff(columns)
    panels = np.concatenate([[0], np.cumsum(in_lanes(widths**2) + widths * in_lanes(np.diff(row_starts)))])
    return SymbolicFactor(order, columns, row_starts, rows, parents, panels)


def in_lanes(count: Integers) -> Integers:
    """Round up to whole groups of eight."""
    return (count + LANES - 1) // LANES * LANES


def permuted(matrix: csr_array, order: Integers) -> csr_array:
    """Return P A P^T with sorted 32-bit column indices, its row i being row order[i] of A."""
    result = csr_array(matrix[order][:, order])
    result.sort_indices()
    result.indptr, result.indices = result.indptr.astype(np.int32), result.indices.astype(np.int32)
    return result


def both_triangles(matrix: csr_array) -> csr_array:
    """Return a matrix of the pattern of A and A^T: sums drop entries that cancel, on one side alone where rounding differs."""
    ones = csr_array((np.ones(matrix.nnz), matrix.indices, matrix.indptr), shape=matrix.shape)
    return csr_array(ones + ones.T)


def _sorted_in_each(row_starts: Integers, rows: Integers, size: int) -> Integers:
    """The rows of every supernode in ascending order."""
    lists = csr_array((np.ones(len(rows), np.int8), rows, row_starts), shape=(len(row_starts) - 1, size))
    lists.sort_indices()
    return np.asarray(lists.indices.astype(np.int64))


def _permuted_pattern(pattern: csr_array, order: Integers) -> tuple[Integers, Integers]:
    shuffled = permuted(pattern, order)
    return shuffled.indptr.astype(np.int64), shuffled.indices.astype(np.int64)


@njit(cache=True, nogil=True)
def _elimination_tree(indptr: Integers, indices: Integers) -> Integers:
    """(n,) parent of each column (Liu 1990), with path compression."""
    n = len(indptr) - 1
    parent, ancestor = np.full(n, -1, np.int64), np.full(n, -1, np.int64)
    for j in range(n):
        for p in range(indptr[j], indptr[j + 1]):
            i = indices[p]
            while i != -1 and i < j:
                above = ancestor[i]
                ancestor[i] = j
                if above == -1:
                    parent[i] = j
                i = above
    return parent


@njit(cache=True, nogil=True)
def _postorder(parent: Integers) -> Integers:
    n = len(parent)
    first_child, sibling = np.full(n, -1, np.int64), np.full(n, -1, np.int64)
    for j in range(n - 1, -1, -1):
        if parent[j] >= 0:
            sibling[j] = first_child[parent[j]]
            first_child[parent[j]] = j
    order, stack = np.empty(n, np.int64), np.empty(n, np.int64)
    count = 0
    for root in range(n):
        if parent[root] != -1:
            continue
        top = 0
        stack[0] = root
        while top >= 0:
            node = stack[top]
            child = first_child[node]
            if child == -1:
                top -= 1
                order[count] = node
                count += 1
            else:
                first_child[node] = sibling[child]
                top += 1
                stack[top] = child
    return order


@njit(cache=True, nogil=True)
def _column_counts(indptr: Integers, indices: Integers, parent: Integers) -> Integers:
    """(n,) entries of each column of L, the diagonal included, by walking the row subtrees."""
    n = len(parent)
    counts, mark = np.ones(n, np.int64), np.full(n, -1, np.int64)
    for i in range(n):
        mark[i] = i
        for p in range(indptr[i], indptr[i + 1]):
            j = indices[p]
            while j < i and mark[j] != i:
                mark[j] = i
                counts[j] += 1
                j = parent[j]
    return counts


@njit(cache=True, nogil=True)
def _supernodes(parent: Integers, counts: Integers) -> Integers:
    """First columns of the supernodes: fundamental ones, then a last child joins its parent where few zeros arise."""
    n = len(parent)
    children = np.zeros(n, np.int64)
    for j in range(n):
        if parent[j] >= 0:
            children[parent[j]] += 1
    starts, below, zeros = np.empty(n + 1, np.int64), np.empty(n, np.int64), np.empty(n)
    count = 0
    end = 0
    while end < n:
        start = end
        end += 1
        while end < n and parent[end - 1] == end and counts[end] == counts[end - 1] - 1 and children[end] == 1:
            end += 1
        starts[count], below[count], zeros[count] = start, counts[end - 1] - 1, 0.0
        count += 1
        while count > 1 and parent[starts[count - 1] - 1] == starts[count - 1]:
            wide, narrow = end - starts[count - 1], starts[count - 1] - starts[count - 2]
            added = zeros[count - 2] + zeros[count - 1] + narrow * (wide + below[count - 1] - below[count - 2])
            width = wide + narrow
            total = 0.5 * width * (width + 1) + width * below[count - 1]
            allowed = 0.8 if width <= 8 else (0.1 if width <= 32 else 0.025)
            if added >= allowed * total:
                break
            below[count - 2], zeros[count - 2] = below[count - 1], added
            count -= 1
    starts[count] = n
    return starts[: count + 1].copy()


@njit(cache=True, nogil=True)
def _supernode_rows(
    indptr: Integers, indices: Integers, columns: Integers, bound: int
) -> tuple[Integers, Integers, Integers]:
    """Rows below each supernode, in no order: those of its own columns and of its children."""
    count, n = len(columns) - 1, len(indptr) - 1
    supernode = np.empty(n, np.int64)
    for s in range(count):
        for j in range(columns[s], columns[s + 1]):
            supernode[j] = s
    starts, parents = np.zeros(count + 1, np.int64), np.full(count, -1, np.int64)
    rows, mark = np.empty(bound, np.int64), np.full(n, -1, np.int64)
    first_child, sibling = np.full(count, -1, np.int64), np.full(count, -1, np.int64)
    end = 0
    for s in range(count):
        start = end
        for p in range(indptr[columns[s]], indptr[columns[s + 1]]):
            i = indices[p]
            if i >= columns[s + 1] and mark[i] != s:
                mark[i] = s
                rows[end] = i
                end += 1
        child = first_child[s]
        while child != -1:
            for p in range(starts[child], starts[child + 1]):
                i = rows[p]
                if i >= columns[s + 1] and mark[i] != s:
                    mark[i] = s
                    rows[end] = i
                    end += 1
            child = sibling[child]
        starts[s + 1] = end
        if end > start:
            first = rows[start]
            for p in range(start + 1, end):
                first = min(first, rows[p])
            parents[s] = supernode[first]
            sibling[s] = first_child[parents[s]]
            first_child[parents[s]] = s
    return starts, rows[:end].copy(), parents
