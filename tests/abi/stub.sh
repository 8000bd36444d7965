# stub.sh, to be sourced: make_stub CC PYTHON HEADER OUT_SO, a shared object with the ABI of HEADER.
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
make_stub() {
    "$2" "$here/stub.py" "$3" "$4.c"
    "$1" -std=c99 -g -fPIC -shared -Wl,-soname,libplm.so.0 -Wl,--version-script="$here/../../cmake/plm.map" \
        "$4.c" -o "$4"
}
skip() {
    echo "skipped: $1"
    exit 77
}
