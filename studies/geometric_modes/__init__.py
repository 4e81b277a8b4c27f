"""Do modes of the cortex explain its maps better than modes of other geometries?"""
