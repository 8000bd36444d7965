#!/bin/sh
# plugin_exports.sh NM PLUGIN: a plug-in that was linked to libplm.a exports its own function, and nothing of libplm, of the
# libraries it carries or of the C++ library.
set -eu
exported=$("$1" -D --defined-only "$2" | awk '{ print $NF }' | grep -vxE '_init|_fini|_edata|_end|__bss_start' || true)
[ "$exported" = plugin_run ] || { echo "exported beside plugin_run:"; printf '%s\n' "$exported" | grep -vx plugin_run | head -20; exit 1; }
echo "exports plugin_run alone"
