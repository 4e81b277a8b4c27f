"""Do null models keep their level? Rejections of maps that have nothing in common, by every null model."""
