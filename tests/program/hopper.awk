# SPDX-License-Identifier: MIT
# scenes/programs/hopper.py in awk, which starts at once and takes less time: mawk -W interactive -f hopper.awk
BEGIN {
  OFMT = "%.17g"
  p = 2
  print "{\"gatewalk\": 1, \"uniforms\": 2, \"parameters\": {\"push_J\": [2, 1, 3]}, \"costs\": [{\"key\": \"time_s\", \"unit\": \"s\"}, {\"key\": \"work_J\", \"unit\": \"J\"}], \"coordinates\": [{\"name\": \"s\", \"unit\": \"m\", \"scale\": 0.1}], \"faces\": [{\"name\": \"S\", \"move\": [0, 1]}]}"
  fflush()
}
NF == 0 { fflush(); next }
$1 == "set" { p = $3; next }
{ off = p - ($3 < 0 ? 1 : 3); if ($5 < 0.9 - 0.3 * (off < 0 ? -off : off)) print $1, "left S", $6 - 0.5, 1, p, "-"; else print $1, "trapped", 1, p }
