"""Stored results as files of the formats that their users open: which, under what names, by which writer, into what folder."""
