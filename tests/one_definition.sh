#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Each struct, class, union or enum has one definition. Two of one name in one namespace, in different files, break the
# program without a message, because the linker takes either. tests/one_definition.sh ROOT reads the sources under ROOT;
# tests/nightly.sh odr asks the compiler as well.
set -euo pipefail

# Prints "NAME: FILE:LINE FILE:LINE" for each name that two of the files define.
repeated() {
  awk '
    # Puts the text of a literal out of sight; a comment goes.
    function visible(line,    out, at, what) {
      out = ""
      while (line != "") {
        if (ends_with != "") {  # inside of a comment or raw string
          at = index(line, ends_with)
          if (!at) return out
          line = substr(line, at + length(ends_with))
          ends_with = ""
          continue
        }
        if (!match(line, /\/\/|\/\*|R"[^(]*\(|"([^"\\]|\\.)*"|'\''([^'\''\\]|\\.)+'\''/)) return out line
        what = substr(line, RSTART, RLENGTH)
        out = out substr(line, 1, RSTART - 1)
        # Not a literal: the separators of 1'\''000'\''000.
        if (what ~ /^'\''/ && out ~ /[0-9a-fA-F]$/) {
          out = out "_"
          line = substr(line, RSTART + 1)
          continue
        }
        line = substr(line, RSTART + RLENGTH)
        if (what == "//") return out
        if (what == "/*") ends_with = "*/"
        else if (what ~ /^R"/) ends_with = ")" substr(what, 3, length(what) - 3) "\""
        else out = out "0"
      }
      return out
    }
    # What stands before a brace, without what may come before struct, class, union or enum.
    function bare(head,    at, depth, c) {
      for (;;) {
        sub(/^[ \t]+/, "", head)
        if (sub(/^(public|private|protected)[ \t]*:/, "", head)) continue
        if (sub(/^(typedef|inline|static|constexpr|const|export)[ \t]+/, "", head)) continue
        if (head !~ /^template[ \t]*</) return head
        depth = 0
        for (at = index(head, "<"); at <= length(head); ++at) {
          c = substr(head, at, 1)
          if (c == "<") ++depth
          if (c == ">" && --depth == 0) break
        }
        head = substr(head, at + 1)
      }
    }
    # The name that a brace after `head` opens: a namespace or a type; "" for an unnamed one, "{" for
    # a function or anything else.
    function opened(head,    is_type) {
      head = bare(head)
      gsub(/\[\[[^]]*\]\]|alignas[ \t]*\([^)]*\)/, "", head)
      gsub(/[ \t]+/, " ", head)
      if (head ~ /^namespace( |$)/) {
        sub(/^namespace ?/, "", head)
        sub(/ $/, "", head)
        return head
      }
      if (!sub(/^(struct|class|union|enum class|enum struct|enum)( |$)/, "", head)) return "{"
      sub(/ final *(:[^:].*)?$/, "", head)
      sub(/ *:[^:].*$/, "", head)
      gsub(/ $/, "", head)
      if (head ~ /^[A-Za-z_0-9:]*( ?<.*>)?$/) {
        defines = head != ""
        return head
      }
      return "{"
    }
    FNR == 1 { depth = 0; hidden = 0; head = ""; ends_with = ""; continued = 0 }
    {
      line = visible($0)
      is_directive = continued || line ~ /^[ \t]*#/
      continued = is_directive && $0 ~ /\\$/
      if (is_directive) next
      while (match(line, /[{};]/)) {
        mark = substr(line, RSTART, 1)
        head = head " " substr(line, 1, RSTART - 1)
        line = substr(line, RSTART + 1)
        if (mark == "{") {
          defines = 0
          name = opened(head)
          if (name == "" || name == "{") ++hidden  # what is within has no name elsewhere
          ++depth
          scope[depth] = name
          if (defines && !hidden) {
            full = ""
            for (i = 1; i <= depth; ++i) full = full (i > 1 ? "::" : "") scope[i]
            if (file_of[full] != "" && file_of[full] != FILENAME) twice[full] = 1
            file_of[full] = FILENAME
            places[full] = places[full] " " FILENAME ":" FNR
          }
        } else if (mark == "}" && depth > 0) {
          if (scope[depth] == "" || scope[depth] == "{") --hidden
          --depth
        }
        head = ""
      }
      head = head " " line
    }
    END { for (full in twice) print full ":" places[full] }' "$@" | sort
}

# It finds them: among others, where text and comments have braces of their own.
trial=$(mktemp -d)
trap 'rm -rf "$trial"' EXIT
cat >"$trial/a.h" <<'END'
namespace a::b {
/* } struct Seen { */
template <class T, class U = std::vector<T>>
class [[nodiscard]] Twice final : public Base<T> {
  struct Inner { char brace = '{'; int many = 1'000'000; };  // }
};
enum class Kind : int { one };
struct Once { const char* text = "} \" {"; const char* raw = R"x(}}})" )x"; };
template <> struct Special<int> {};
inline int f() { struct Local {}; return 0; }
namespace { struct Unnamed {}; }
struct Declared;
}
END
sed 's/Once/Other/; s/<int>/<char>/' "$trial/a.h" >"$trial/b.h"
found=$(cd "$trial" && repeated a.h b.h)
wanted="a::b::Kind: a.h:7 b.h:7
a::b::Twice: a.h:4 b.h:4
a::b::Twice::Inner: a.h:5 b.h:5"
[ "$found" = "$wanted" ] || { printf 'one_definition.sh itself is broken: found\n%s\n' "$found" >&2; exit 1; }

cd "$1"
for module in dynamics markov lattice cli; do  # each of them with the tests that it is linked to
  mapfile -t files < <(find dynamics markov lattice cli tests/support tests/$module -name '*.h' -o -name '*.cpp' | sort)
  [ ${#files[@]} -gt 100 ] || { echo "no sources under $1" >&2; exit 1; }
  found=$(repeated "${files[@]}")
  [ -z "$found" ] || { printf 'defined more than once:\n%s\n' "$found" >&2; exit 1; }
done
