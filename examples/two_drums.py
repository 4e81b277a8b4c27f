"""Do two drums of different shape sound the same, and does anything tell them apart?"""

import numpy as np

import surfexp as sx

# %%
# Gordon, Webb and Wolpert (1992): seven right triangles, each reflected over a side of one that is there already. Each row
# is the tile that is reflected, and the corner opposite to the side.
FIRST = ((0, 2), (1, 0), (1, 1), (2, 2), (4, 1), (5, 0))
SECOND = ((0, 2), (1, 1), (2, 0), (3, 2), (4, 0), (4, 1))


def drum(name, reflections, divisions=12):
    tiles = [np.array([[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]])]
    for tile, corner in reflections:
        mirrored = tiles[tile].copy()
        start, end = np.delete(mirrored, corner, axis=0)
        along = (end - start) / np.linalg.norm(end - start)
        mirrored[corner] = 2.0 * (start + along * ((mirrored[corner] - start) @ along)) - mirrored[corner]
        tiles.append(mirrored)
    n = divisions
    shares = np.array([(n - i - j, i, j) for i in range(n + 1) for j in range(n + 1 - i)]) / n
    place = {tuple(np.rint(share[1:] * n).astype(int)): k for k, share in enumerate(shares)}
    lower = [(place[i, j], place[i + 1, j], place[i, j + 1]) for i, j in place if i + j < n]
    upper = [(place[i + 1, j], place[i + 1, j + 1], place[i, j + 1]) for i, j in place if i + j < n - 1]
    faces = np.concatenate([np.array(lower + upper) + k * len(shares) for k in range(7)])
    points, same = np.unique(np.round(np.concatenate([shares @ t for t in tiles]), 9), axis=0, return_inverse=True)
    faces = same.ravel()[faces]
    a, b, c = (points[faces[:, k]] for k in range(3))
    turned = np.linalg.det(np.stack([b - a, c - a], axis=1)) < 0.0
    faces[turned] = faces[turned][:, ::-1]
    return sx.Surface((np.column_stack([points, np.zeros(len(points))]), faces), name=name)


# %%
# With a held boundary the two meshes have the same eigenvalues to rounding: sums of three tiles of a mode of one drum are a
# mode of the other.
drums = [drum("one drum", FIRST), drum("the other drum", SECOND)]
held = [sx.eigenpairs(one, 10, boundary="dirichlet") for one in drums]
for k in range(4):
    print(f"mode {k + 1}: {held[0].values[k]:.9f} and {held[1].values[k]:.9f}")
print(f"largest relative difference of ten {np.abs(held[0].values / held[1].values - 1).max():.0e}")
free = [sx.eigenpairs(one, 10) for one in drums]
print(f"with a free boundary {np.abs(free[0].values[1:] / free[1].values[1:] - 1).max():.0e}")

# %%
# They sound the same and look different: the white nodal lines of the fourth mode cut one drum into three parts, the other
# one into four.
fourth = [one.vectors[:, 3] / np.abs(one.vectors[:, 3]).max() for one in held]
picture = sx.plot(drums, fourth, views="top", limits=(-1, 1), label="fourth mode", width=900)
