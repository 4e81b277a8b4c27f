"""Which files of a folder are taken for meshes, by everything that reads folders."""

MESH_PATTERNS = ("*.off", "*.obj", "*.ply", "*.stl", "*.vtk", "*.vtp", "*.vtu", "*.vert", "*.surf.gii", "*.surf.gii.gz")
