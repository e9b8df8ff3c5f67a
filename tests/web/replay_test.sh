#!/usr/bin/env bash
# replay_test.sh MAKE_REPLAYS: makes the pages and looks at them.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$1" "$folder"
node "$(dirname "$0")/replay_test.mjs" "$folder"
