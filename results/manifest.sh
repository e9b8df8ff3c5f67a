# SPDX-License-Identifier: MIT
# Sourced by the studies: where a result came from. $gatewalk is the program that made it.
manifest() {
  echo "command: $1"
  echo "program: $("$gatewalk" --version)"
  echo "machine: $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores, $(. /etc/os-release && echo "$PRETTY_NAME")"
}
# The program's figures are light or dark as the reader's screen is: by the same style one that a script drew.
light_or_dark() {
  sed -n '/<style>/,/<\/style>/p' "$root/results/pictures/prediction.svg" | sed -i '/<\/desc>/r /dev/stdin' "$1"
}
