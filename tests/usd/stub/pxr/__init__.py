"""A stub of OpenUSD's Python module, with what tools/usd2vdbeam.py uses of it: a reader of simple .usda files without
composition. The real module is not packaged by Debian."""
from . import Usd, UsdGeom, UsdShade
