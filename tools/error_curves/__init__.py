"""Error against run time, from the reports of `vdbeam render`; used by tools/error_vs_time.py."""
