# Sourced by the studies: where a result came from. $gatewalk is the program that made it.
manifest() {
  echo "command: $1"
  echo "program: $("$gatewalk" --version)"
  echo "machine: $(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1), $(nproc) cores, $(. /etc/os-release && echo "$PRETTY_NAME")"
}
