"""Parts of tools/make_results.py."""
