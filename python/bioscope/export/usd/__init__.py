"""USD through `pxr`: a stage whose attributes are sampled only while they change."""
