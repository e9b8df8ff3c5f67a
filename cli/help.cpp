// SPDX-License-Identifier: MIT
#include "cli/help.h"

#include <fmt/core.h>

#include <cctype>
#include <charconv>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <map>
#include <vector>

#include "cli/commands.h"
#include "cli/fields/schema.h"
#include "cli/render/version.h"
#include "cli/scene_keys.h"
#include "cli/terminal/output.h"

namespace gatewalk::cli {
namespace {

struct Page {
  std::string name, summary;
  CommandHelp help;

  /// The words of the command's name; second() is empty for a name of one word.
  [[nodiscard]] std::string first() const { return name.substr(0, name.find(' ')); }
  [[nodiscard]] std::string second() const {
    return name.size() > first().size() ? name.substr(first().size() + 1) : "";
  }
};

std::vector<Page> pages() {
  std::vector<Page> all;
  for (const Command& c : commands()) {
    Arguments arguments{};
    arguments.helped = [&](const CommandHelp& help) { all.push_back({c.name, c.summary, help}); };
    (void)c.run(arguments);
  }
  return all;
}

std::string day() {
  std::time_t now = std::time(nullptr);
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) {
    const std::string text = epoch;
    std::from_chars(text.data(), text.data() + text.size(), now);
  }
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::string text(10, ' ');
  return text.substr(0, std::strftime(text.data(), text.size() + 1, "%Y-%m-%d", &parts));
}

// ---- Manual pages ----

/// Text escaped for a manual page.
std::string roff(const std::string& text) {
  std::string out;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    at_start = c == '\n';
  }
  return out;
}

std::string header(const std::string& title, const std::string& summary) {
  std::string upper = title;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return fmt::format(".TH {} 1 {} \"gatewalk {}\" \"User commands\"\n.SH NAME\n{} \\- {}\n",
                     roff(upper), day(), kVersion, roff(title), roff(summary));
}

std::string exit_status() {
  return ".SH EXIT STATUS\n.TP\n0\nfine\n.TP\n1\nfailure; with \\-\\-strict also a result "
         "whose status is not clean\n.TP\n2\nwrong use or input\n.TP\n75\nstopped; the same "
         "command with "
         "\\-\\-resume goes on\n.TP\n130\nstopped by a signal, nothing was kept\n.TP\n141\nthe "
         "reader of a pipe went away, as in | head; all other files are written\n";
}

std::string manual_of(const Page& page) {
  std::string text = header("gatewalk-" + file_name_of(page.name), page.summary);
  text += fmt::format(".SH SYNOPSIS\n.B gatewalk {}\n.SH DESCRIPTION\n{}\n",
                      roff(page.help.synopsis), roff(page.help.about));
  for (const auto& [name, what] : page.help.arguments)
    text += fmt::format(".TP\n.I {}\n{}\n", roff(name), roff(what));
  text += ".SH OPTIONS\n";
  std::string group;
  for (const CommandHelp::Option& o : page.help.options) {
    if (o.group != group) text += fmt::format(".SS {}\n", roff(o.group));
    group = o.group;
    text += ".TP\n";
    if (o.letter != 0) text += fmt::format("\\fB\\-{}\\fR, ", o.letter);
    text +=
        fmt::format("\\fB{}\\fR{}\n{}\n", roff("--" + o.name),
                    o.value.empty() ? "" : fmt::format(" \\fI{}\\fR", roff(o.value)), roff(o.text));
  }
  text += fmt::format("{}.SH EXAMPLE\n.nf\n{}\n.fi\n", exit_status(), roff(page.help.example));
  return text + ".SH SEE ALSO\n.BR gatewalk (1)\n";
}

std::string manual(const std::vector<Page>& all) {
  std::string text =
      header("gatewalk",
             "multi-scale Markov chain analysis of locomotion through cluttered obstacles") +
      ".SH SYNOPSIS\n.B gatewalk\n.I COMMAND\n[arguments] [options]\n.SH DESCRIPTION\n"
      "A disc-shaped body pushes through a field of gates, pairs of hinged springy beams. "
      "Short runs of single gates make a transition matrix, a Markov chain walks the field with "
      "it, and its "
      "final gates are compared with the full dynamics.\n.SH COMMANDS\n";
  for (const Command& c : kCommandsAndGroups)
    text += c.run ? fmt::format(".TP\n.BR {} (1)\n{}\n", roff("gatewalk-" + file_name_of(c.name)),
                                roff(c.summary))
                  : fmt::format(".SS {}\n", roff(c.name));
  text += exit_status() + ".SH SEE ALSO\n";
  for (std::size_t k = 0; k < all.size(); ++k)
    text += fmt::format(".BR {} (1){}\n", roff("gatewalk-" + file_name_of(all[k].name)),
                        k + 1 < all.size() ? "," : "");
  return text;
}

// ---- Completion ----

/// Text in single quotes of a shell.
std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}
std::string one_line(std::string text) {
  for (char& c : text)
    if (c == '\n') c = ' ';
  return text;
}

/// A name as a pattern of the shell's `case`.
std::string pattern(const std::string& name) {
  const std::size_t blank = name.find(' ');
  return blank == name.npos ? name : name.substr(0, blank) + "\\" + name.substr(blank);
}

/// Pages of commands with two words in their name, by the first word (chart).
std::map<std::string, std::vector<const Page*>> families(const std::vector<Page>& all) {
  std::map<std::string, std::vector<const Page*>> found;
  for (const Page& page : all)
    if (!page.second().empty()) found[page.first()].push_back(&page);
  return found;
}

std::string for_bash(const std::vector<Page>& all) {
  std::string commands, cases, seconds;
  for (const auto& [first, pages] : families(all)) {
    std::string names;
    for (const Page* page : pages) names += page->second() + " ";
    commands += first + " ";
    seconds += fmt::format(R"(    {0})
      if [ "$COMP_CWORD" = 2 ]; then
        mapfile -t COMPREPLY < <(compgen -W {1} -- "$current")
        return
      fi
      command="{0} ${{COMP_WORDS[2]}}"
      ;;
)",
                           first, in_quotes(names));
  }
  for (const Page& page : all) {
    if (page.second().empty()) commands += page.name + " ";
    std::string options;
    for (const CommandHelp::Option& o : page.help.options) options += fmt::format("--{} ", o.name);
    cases += fmt::format("    {}) options={} ;;\n", pattern(page.name), in_quotes(options));
  }
  return fmt::format(R"(# Completion of gatewalk for bash.
_gatewalk() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} command=${{COMP_WORDS[1]}} options=
  COMPREPLY=()
  if [ "$COMP_CWORD" = 1 ]; then
    mapfile -t COMPREPLY < <(compgen -W {} -- "$current")
    return
  fi
  case $command in
{}  esac
  case $command in
{}    help) options={} ;;
  esac
  case $current in
    -*) mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current") ;;
    *)
      [ "${{COMP_WORDS[1]}}" != help ] || mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
      [ ${{#COMPREPLY[@]}} -gt 0 ] || mapfile -t COMPREPLY < <(compgen -f -- "$current")
      ;;
  esac
}}
complete -o filenames -F _gatewalk gatewalk
)",
                     in_quotes(commands + "help --help --version"), seconds, cases,
                     in_quotes(commands));
}

std::string for_zsh(const std::vector<Page>& all) {
  std::string text =
      "#compdef gatewalk\n# Completion of gatewalk for zsh.\n_gatewalk() {\n"
      "  local -a commands=(\n";
  const auto plain = [](const std::string& words) {  // : [ and ] have a meaning in _arguments
    std::string out;
    for (const char c : one_line(words)) {
      if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
      out += c;
    }
    return out;
  };
  const auto described = [&](const std::string& name, const std::string& summary) {
    return fmt::format("    {}\n", in_quotes(name + ":" + plain(summary)));
  };
  std::string seconds;
  for (const auto& [first, pages] : families(all)) {
    std::string names;
    seconds += fmt::format("    {})\n      local -a seconds=(\n", first);
    for (const Page* page : pages) {
      seconds += "    " + described(page->second(), page->summary);
      names += (names.empty() ? "" : ", ") + page->second();
    }
    seconds += fmt::format(
        "      )\n      if (( CURRENT == 3 )); then\n        _describe {0} seconds\n        "
        "return\n      fi\n      command=\"{0} $words[3]\"\n      ;;\n",
        first);
    text += described(first, names);
  }
  for (const Page& page : all)
    if (page.second().empty()) text += described(page.name, page.summary);
  text +=
      "  )\n  if (( CURRENT == 2 )); then\n    _describe command commands\n    return\n  fi\n"
      "  local command=$words[2]\n  case $command in\n" +
      seconds + "  esac\n  case $command in\n";
  for (const Page& page : all) {
    text += fmt::format("    {})\n      _arguments", pattern(page.name));
    for (const CommandHelp::Option& o : page.help.options)
      text += " \\\n        " +
              in_quotes(fmt::format(
                  "*--{}[{}]{}", o.name, plain(o.text),
                  o.value.empty() ? "" : ":" + plain(o.value) + (o.is_file ? ":_files" : ":")));
    text += " \\\n        '*:file:_files'\n      ;;\n";
  }
  return text + "  esac\n}\n_gatewalk \"$@\"\n";
}

std::string for_fish(const std::vector<Page>& all) {
  std::string text = "# Completion of gatewalk for fish.\n";
  const auto escaped = [](const std::string& words) {
    std::string out = "'";
    for (const char c : one_line(words)) {
      if (c == '\'' || c == '\\') out += '\\';
      out += c;
    }
    return out + "'";
  };
  const auto offer = [&](const std::string& when, const std::string& word,
                         const std::string& summary) {
    text +=
        fmt::format("complete -c gatewalk -n {} -f -a {} -d {}\n", when, word, escaped(summary));
  };
  const std::string seen = "__fish_seen_subcommand_from ";
  for (const auto& [first, pages] : families(all)) {
    std::string names;
    for (const Page* page : pages) names += " " + page->second();
    offer("__fish_use_subcommand", first, one_line(names.substr(1)));
    for (const Page* page : pages)
      offer(fmt::format("'{0}{1}; and not {0}{2}'", seen, first, names.substr(1)), page->second(),
            page->summary);
  }
  for (const Page& page : all)
    if (page.second().empty()) offer("__fish_use_subcommand", page.name, page.summary);
  for (const Page& page : all)
    for (const CommandHelp::Option& o : page.help.options)
      text += fmt::format("complete -c gatewalk -n '{}{}{}' -l {}{} -d {}\n", seen, page.first(),
                          page.second().empty() ? "" : "; and " + seen + page.second(), o.name,
                          o.value.empty() ? ""
                          : o.is_file     ? " -r"
                                          : " -x",
                          escaped(o.text));
  return text;
}

}  // namespace

void write_help(const std::string& share) {
  const std::filesystem::path root = share;
  const auto write = [&](const std::string& file, const std::string& text) {
    std::filesystem::create_directories((root / file).parent_path());
    write_text_atomically((root / file).string(), text);
  };
  const std::vector<Page> all = pages();
  for (const ResultOf& of : results())
    write(fmt::format("gatewalk/schemas/{}.schema.json", file_name_of(of.command)), schema_of(of));
  write("doc/gatewalk/results.md", results_in_markdown());
  write("doc/gatewalk/scene.md", scene_keys_in_markdown());
  write("man/man1/gatewalk.1", manual(all));
  for (const Page& page : all)
    write(fmt::format("man/man1/gatewalk-{}.1", file_name_of(page.name)), manual_of(page));
  write("bash-completion/completions/gatewalk", for_bash(all));
  write("zsh/vendor-completions/_gatewalk", for_zsh(all));
  write("fish/vendor_completions.d/gatewalk.fish", for_fish(all));
}

}  // namespace gatewalk::cli
