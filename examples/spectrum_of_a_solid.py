"""What are the lowest frequencies of a box that is cut into tetrahedra, and do they approach the exact ones?"""

from itertools import permutations

import numpy as np

import surfexp as sx

# %%
# A solid is tetrahedra; the box makes them from cubes.
SIDES = np.array([1.0, 1.3, 0.7])


def box(cells: int) -> sx.Solid:
    """Cut a box into cubes and each cube into the six tetrahedra along its diagonal."""
    grid = np.stack(np.meshgrid(*[np.arange(cells + 1)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    steps = np.array(
        [np.cumsum([[0, 0, 0], *np.eye(3, dtype=int)[list(order)]], axis=0) for order in permutations(range(3))]
    )
    corners = grid[(grid < cells).all(axis=1)][:, None, None] + steps
    return sx.Solid(grid / cells * SIDES, (corners @ [(cells + 1) ** 2, cells + 1, 1]).reshape(-1, 4))


# %%
# A free box has the frequencies pi^2 (a^2 + b^2 + c^2) over the squares of its sides. Errors fall with the square of the
# edge length.
exact = np.sort([np.pi**2 * ((np.array(n) / SIDES) ** 2).sum() for n in np.ndindex(5, 5, 5)])[:8]
coarse, fine = (sx.eigsh(box(cells).stiffness, k=8, M=box(cells).mass, sigma=0)[0] for cells in (8, 16))
for row in zip(exact[1:], coarse[1:], fine[1:], strict=True):
    print("exact {:.3f}, coarse {:.3f}, fine {:.3f}".format(*row))
print(f"the errors are {((coarse - exact)[1:] / (fine - exact)[1:]).mean():.2f} times smaller at half the edge length")

# %%
# Shape DNA is scaled by the volume: the box twice as large has the same.
small = box(8)
large = sx.Solid(2.0 * small.vertices, small.tetrahedra)
print(f"shape DNA {small.shape_dna(3).round(3)}, of a box twice as large {large.shape_dna(3).round(3)}")
