"""Do Reeb skeletons describe a group of patches? Corpora callosa and cingulate gyri by eigenmaps and flux weights."""
