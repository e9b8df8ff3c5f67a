#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# licences_test.sh SOURCE: every file has a copyright and a licence (REUSE), and codemeta.json is what
# CITATION.cff says.
set -euo pipefail
cd "$1"
command -v reuse >/dev/null || { echo "reuse is not installed"; exit 77; }
python3 -c 'import yaml' 2>/dev/null || { echo "PyYAML is not installed"; exit 77; }
reuse lint
python3 cli/packaging/codemeta.py CITATION.cff | diff codemeta.json -
