#!/bin/sh
# pip_install.sh PYTHON PACKAGE LIBRARY WORK: "pip install PACKAGE" without network into a fresh environment; the package
# then works from anywhere, finds the library by PLM_LIBRARY and beside itself, and says so when there is none.
set -eu
python=$1 package=$2 library=$3 work=$4
unset PYTHONPATH PYTHONDONTWRITEBYTECODE PLM_LIBRARY LD_LIBRARY_PATH
"$python" -c 'import pip, venv' 2>/dev/null || { echo "skipped: no pip or venv for $python"; exit 77; }
rm -rf "$work"
mkdir -p "$work"
"$python" -m venv --without-pip --system-site-packages "$work/env"
cp -r "$package" "$work/source" # pip may leave files beside the package
env PIP_NO_INDEX=1 PIP_DISABLE_PIP_VERSION_CHECK=1 "$work/env/bin/python" -m pip install -q "$work/source"
cd "$work"
try='import plm; print(plm.version(), plm._c.lib.path, plm.__file__)'
PLM_LIBRARY=$library env/bin/python -c "$try" | grep "$work/env"
PLM_LIBRARY=$library env/bin/plm --version | grep '^plm, libplm ' # the command is installed, too
test -s env/share/man/man1/plm.1 # and its manual page
installed=$(dirname "$(PLM_LIBRARY=$library env/bin/python -c 'import plm; print(plm.__file__)')")
ln -s "$library" "$installed/libplm.so.0"
env/bin/python -c "$try" | grep "$installed/libplm.so.0"
if PLM_LIBRARY=/nowhere/libplm.so env/bin/python -c "$try" 2>message; then exit 1; fi
grep -q 'ImportError: libplm was not found.*PLM_LIBRARY' message
