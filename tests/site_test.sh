#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The documentation site: it is built without a warning, its links work, nothing is loaded from elsewhere, nothing is
# missing, and a browser shows it light, dark, narrow and by keyboard. Faults that are put into it must be found.
#   site_test.sh PROGRAM PYTHONPATH OUT
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
program=$(realpath "$1") modules=$(realpath "$2") out=$3
web=$root/tests/web
[ -d "$web/node_modules/playwright-core" ] || { echo "playwright-core is not installed: npm ci --prefix tests/web"; exit 77; }
"$root/cli/site/build.sh" "$program" "$modules" "$out"
export PYTHONPATH=$modules PYTHONDONTWRITEBYTECODE=1
check() { /usr/bin/python3 "$root/cli/site/check.py" "$1" "$root" "$program"; }
check "$out/html"
node "$web/site_test.mjs" "$out/html"

failures=0
broken=$out/broken
must_find() {  # WHAT FILE SED-SCRIPT: what check.py must say of a site whose FILE was changed so
  rm -rf "$broken"
  cp -r "$out/html" "$broken"
  sed -i "$3" "$broken/$2"
  cmp -s "$broken/$2" "$out/html/$2" && { echo "FAILED: $2 was not changed by $3"; failures=1; }
  check "$broken" >"$out/broken.log" && { echo "FAILED: not found: $1"; failures=1; }
  grep -qF -- "$1" "$out/broken.log" || { echo "FAILED: no word of: $1"; cat "$out/broken.log"; failures=1; }
}
must_find 'which is not there' glossary.html 's|href="guides/markov.html"|href="guides/markow.html"|'
must_find 'which has no such anchor' guides/own_robot.html 's|id="what-to-measure"|id="measured"|'
must_find 'loads https://example.org/a.png' index.html 's|<h1>|<img src="https://example.org/a.png">&|'
must_find 'loads //example.org/a.css' _static/site.css '$ a @import url(//example.org/a.css);'
must_find 'gatewalk.power is not documented' python.html 's|id="gatewalk.power"||'
must_find '--accuracy is not documented' commands/predict.html 's|id="cmdoption-gatewalk-predict-accuracy"||'
must_find 'gatewalk::markov::Walker is not documented' cpp/markov.html 's|markov6WalkerE|markov6Walkerd|g'
rm -rf "$broken"
[ $failures = 0 ] && echo "all fine"
exit $failures
