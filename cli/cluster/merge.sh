#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Merges all parts in FOLDER and writes the command's outputs.   merge.sh FOLDER
set -euo pipefail
cd "$1"/..
exec "$GATEWALK" merge "$1"/part*[0-9] --quiet
