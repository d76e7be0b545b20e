"""Prints the folder for packages below a prefix, relative to it: one in which this interpreter looks, if there is such a one."""
import os
import site
import sys
import sysconfig

prefix = os.path.normpath(sys.argv[1])
for folder in [*site.getsitepackages(), sysconfig.get_path("platlib")]:
    relative = os.path.relpath(folder, prefix)
    if not relative.startswith(".."):
        print(relative)
        break
else:
    print(os.path.relpath(sysconfig.get_path("platlib", "posix_prefix", {"base": "/", "platbase": "/"}), "/"))
