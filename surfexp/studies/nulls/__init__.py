"""Do null models keep what they claim?"""
