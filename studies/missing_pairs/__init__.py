"""Does the usual eigensolver return all the lowest eigenpairs?"""
