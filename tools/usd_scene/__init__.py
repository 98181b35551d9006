"""Reads USD stages for tools/usd2vdbeam.py. Prims are read by the names of their attributes, so that any version of
`pxr` from 21.02 on will do; only stage.py imports it."""
