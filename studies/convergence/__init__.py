"""How fast do eigenvalues, eigenfunctions and spectral distances converge?"""
