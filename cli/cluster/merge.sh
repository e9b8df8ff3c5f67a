#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# One run of all parts in FOLDER: writes what the command was told to write.   merge.sh FOLDER
set -euo pipefail
cd "$1"/..
exec "$GATEWALK" merge "$1"/part*[0-9] --quiet
