// SPDX-License-Identifier: MIT
#include "cli/paper/reproduction.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <fmt/chrono.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <map>
#include <optional>

#include "cli/command.h"
#include "cli/fields/json.h"
#include "cli/fields/json_value.h"
#include "cli/fields/text.h"
#include "cli/paper/figures.h"
#include "cli/paper/page.h"
#include "cli/paper/studies.h"
#include "cli/render/figure.h"
#include "cli/render/provenance.h"
#include "cli/render/version.h"
#include "cli/terminal/gnuplot.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"
#include "cli/web/embedded.h"
#include "dynamics/base/work.h"

namespace gatewalk::cli {
namespace {

constexpr char kDone[] = "data/done.json";
constexpr std::array<const char*, 5> kScenes{"scenes/single_gate.toml", "scenes/soft_left.toml",
                                             "scenes/fig8.toml", "scenes/fig12.toml",
                                             "scenes/field.toml"};

/// The build's identity. A commit alone does not distinguish two builds of changed sources.
std::string build_id() {
  const char* const self = "/proc/self/exe";
  std::error_code error;
  return fmt::format("{} {} {} {}", kVersion, kCommit, std::filesystem::file_size(self, error),
                     std::filesystem::last_write_time(self, error).time_since_epoch().count());
}

/// A file of the folder; nullopt if it cannot be read.
std::optional<std::string> file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}
/// A file of the folder as JSON; discarded if it cannot be read or is not JSON.
Json read_json(const std::string& path) { return parsed_json(file_text(path).value_or("")); }

/// Throws UsageError if a scene in the working folder, called `folder`, would be replaced although
/// it is the user's own: neither the program's scene nor one of an earlier report.
void require_no_scene_of_ones_own(const std::string& folder) {
  const Json::json_pointer place("/made_by/scenes");
  const Json old = read_json("report.json"),
             scenes = old.contains(place) ? old.at(place) : Json::array();
  for (const char* name : kScenes)
    if (const auto text = file_text(name);
        text && *text != carried_file(name) &&
        std::find(scenes.begin(), scenes.end(), Json{{"name", name}, {"text", *text}}) ==
            scenes.end())
      throw UsageError(fmt::format(
          "-o {}: its {} is not the paper's and would be replaced; choose another folder", folder,
          name));
}

/// Locks the current folder against other processes during the object's life.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder)
      : fd_(::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (fd_ < 0 || ::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      if (fd_ >= 0) ::close(fd_);
      throw std::runtime_error(folder + (error == EWOULDBLOCK
                                             ? ": another gatewalk reproduce works in it"
                                             : std::string(": ") + std::strerror(error)));
    }
  }
  ~FolderLock() { ::close(fd_); }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int fd_;
};

/// Changes to a folder, and back in the destructor.
class InFolder {
 public:
  explicit InFolder(const std::string& folder) { std::filesystem::current_path(folder); }
  ~InFolder() {
    std::error_code ignored;
    std::filesystem::current_path(before_, ignored);
  }
  InFolder(const InFolder&) = delete;
  InFolder& operator=(const InFolder&) = delete;

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

/// The results of all studies.
struct Results {
  Findings findings;
  double seconds = 0.0;  // of all studies
};

/// A finished study, as recorded in data/done.json.
struct Record {
  std::string study, command, program, remarks;
  double seconds = 0.0;
};

void describe(Fields& out, const std::vector<Record>& records) {
  for (const Record& r : records)
    out.object({r.study, "a finished study"}, [&](Fields& f) {
      f.text({"command", "the command of the study"}, r.command);
      f.text({"program", "the build that ran it"}, r.program);
      f.optional(!r.remarks.empty(), [&](Fields& some) {
        some.text({"remarks", "what the command warned of"}, r.remarks);
      });
      f.number({"seconds", "s", "time that it took"}, r.seconds);
    });
}

/// The records of data/done.json, without those that lack a key or have one of another type.
std::vector<Record> read_records() {
  std::vector<Record> records;
  const Json done = read_json(kDone);
  for (const auto& [study, record] : done.items()) {
    try {
      records.push_back({study, record.at("command"), record.at("program"),
                         record.value("remarks", ""), record.at("seconds")});
    } catch (const Json::exception&) {
      continue;
    }
  }
  return records;
}

/// The records of finished studies. Each is written at once, so that an interrupted run continues
/// from there. A study has no record while it is run again.
class Records {
 public:
  /// Takes the result of a study. Returns false if the study is not done, was run by another
  /// command or build, or cannot be read.
  [[nodiscard]] bool take(const Study& s, Findings& findings) const {
    try {
      const Record& known = of(s);
      if (known.command != s.text() || known.program != build_id()) return false;
      for (auto word = s.arguments.begin(); word != s.arguments.end(); ++word)
        if (*word == "--figure" && !std::filesystem::exists(*(word + 1))) return false;
      take_file(s, findings);
      return true;
    } catch (const std::exception&) {  // another run's file, or an incomplete one
      return false;
    }
  }
  /// Runs a study, records it and takes its result.
  void make(const Study& s, const dynamics::Work& work, Findings& findings) {
    if (std::erase_if(done_, [&](const Record& r) { return r.study == s.name; }) > 0) write();
    const dynamics::Stopwatch watch;
    const std::string remarks = run(s, work);
    take_file(s, findings);
    done_.push_back({s.name, s.text(), build_id(), remarks, watch.seconds()});
    write();
  }
  /// The record of a study. Throws std::out_of_range if there is none.
  [[nodiscard]] const Record& of(const Study& s) const {
    return done_.at(
        static_cast<std::size_t>(std::ranges::find(done_, s.name, &Record::study) - done_.begin()));
  }

 private:
  static std::string file_of(const Study& s) { return "data/" + s.name + ".json"; }
  /// Takes a study's file. Throws std::exception if the file is not a result of the study.
  static void take_file(const Study& s, Findings& findings) {
    const Json data = read_json(file_of(s));
    (void)data.at("made_by");
    if (s.take) s.take(findings, data);
  }
  /// Runs the study's command and returns its warnings. They belong to the study: the paper's own
  /// scheme, for example, shows faults.
  static std::string run(const Study& s, const dynamics::Work& work) {
    std::string remarks;
    Arguments arguments = s.arguments;
    arguments.words.insert(arguments.words.end(), {"--quiet", "--force", "--json", file_of(s)});
    arguments.work = work;
    arguments.warned = [&](const std::string& text) { remarks += "gatewalk: " + text + "\n"; };
    if (const int status = s.run(arguments); status != kFine)
      throw std::runtime_error(
          fmt::format("{}: ended with status {}. {}", s.text(), status, remarks));
    return remarks;
  }
  void write() const {
    write_text_atomically(kDone, json_text([&](Fields& out) { describe(out, done_); }) + "\n");
  }

  std::vector<Record> done_ = read_records();
};

/// Runs the studies that are not done, and takes the results of all.
Results carry_out(const std::vector<Study>& studies, bool talk, bool each) {
  Records records;
  Results results;
  std::vector<const Study*> left;
  std::int64_t cost = 0;
  for (const Study& s : studies) {
    if (records.take(s, results.findings)) continue;
    left.push_back(&s);
    cost += s.cost;
  }
  std::size_t number = studies.size() - left.size();
  if (talk && number > 0)
    std::cout << number << " of " << studies.size() << " studies are done already\n" << std::flush;
  Progress progress("studies", cost, talk);
  std::int64_t done = 0;
  for (const Study* s : left) {
    progress.name(s->name);
    const dynamics::Work whole{[&](std::string_view, std::int64_t now, std::int64_t) {
      if (interrupted()) throw Interrupted{};
      progress.update(now);
    }};
    whole.tell(s->name, done, cost);
    records.make(*s,
                 whole.part(s->name, static_cast<double>(done), static_cast<double>(s->cost), cost),
                 results.findings);
    done += s->cost;
    progress.finish();
    ++number;
    if (each)
      std::cout << fmt::format(
                       "{:>8}  {:<18}{:>7} s{}\n", fmt::format("[{}/{}]", number, studies.size()),
                       s->name, fixed(records.of(*s).seconds, 1),
                       records.of(*s).remarks.empty() ? "" : "   (with remarks: data/done.json)")
                << std::flush;
  }
  for (const Study& s : studies) results.seconds += records.of(s).seconds;
  return results;
}

/// Writes the scenes that the studies name.
std::vector<Report::Scene> write_scenes() {
  std::vector<Report::Scene> scenes;
  for (const char* name : kScenes) {
    scenes.push_back({name, std::string(carried_file(name))});
    write_text_atomically(name, scenes.back().text);
  }
  return scenes;
}

/// The paragraphs at the beginning of the page.
std::vector<std::string> lead_of(const Report& r) {
  std::vector<std::string> lead{
      "The results of the paper, Figs. 5, 6, 8, 9, 11, 12 and Table IV, and what its abstract "
      "and its Sections II and III claim, made again from the model alone, beside the paper's "
      "own values.",
      fmt::format(
          "Of {} claims: {}. \"Agrees\" means that it deviates by no more than the paper's 100 "
          "trials a point would show (of Table IV: that the printed pair fits only one of two "
          "readings of what was compared, trials with the exact chain or with 100 walks); \"cannot "
          "tell\", that the trials here are too few. Why a claim differs, as far as it is known, "
          "stands beside it. Intervals are 95 % (Jeffreys).",
          r.claims.size(), r.tally()),
      "Symbols as in the paper: F_prop propulsive force, Rm random force (N); k_L, k_R stiffness "
      "of the left and right beam (N m/rad), d their damping (N m s/rad, printed as N s/rad) "
      "and, of a start, the place where it enters (m); RT, LT: entries through the sides above "
      "the joints."};
  if (r.quick)
    lead.push_back(
        "This is the quick version: few trials, wide intervals. The full one, without --quick, "
        "takes some four minutes.");
  return lead;
}

Report report_of(const Results& results, const std::vector<Study>& studies, bool quick,
                 const std::vector<Report::Scene>& scenes) {
  std::map<std::string, std::string> commands;
  for (const Study& s : studies) commands[s.name] = s.text();
  Report r{.title = "Cluttered obstacle traversal: what gatewalk reproduces",
           .paper =
               "B. Zheng, Q. Xuan and C. Li, A minimalistic stochastic dynamics model of "
               "cluttered obstacle traversal, IEEE Robotics and Automation Letters (2022)",
           .quick = quick,
           .claims = claims_of(results.findings)};
  r.lead = lead_of(r);
  r.first = {{"crossing.svg",
              "Twenty paths from the middle of the lower edge into the field, each with a disc "
              "where it ended; of the nine by nine gates only the rows and columns that bodies "
              "reached are drawn.",
              "Full dynamics: twenty bodies push into the field of 9 x 9 gates; drawn are the rows "
              "and columns that they reached.",
              commands.at("crossing_ways")},
             {"prediction.svg",
              "A map of nine by nine gates coloured by the share of bodies that end in each, and "
              "bars of how they end.",
              "Markov chain: in which gate bodies end, and how.", commands.at("prediction")}};
  r.sections = sections_of(results.findings, commands);
  r.made_by = {.program = fmt::format("gatewalk {} ({})", kVersion, kCommit),
               .command = std::string("gatewalk reproduce") + (quick ? " --quick" : ""),
               .machine = machine(),
               .date = fmt::format("{:%F}", fmt::gmtime(std::time(nullptr))),
               .seconds = results.seconds,
               .scenes = scenes};
  return r;
}

/// The SVG of this name in the folder. Throws std::runtime_error.
std::string drawn_figure(const std::string& name) {
  if (auto text = file_text(name)) return *text;
  throw std::runtime_error("cannot read " + name);
}

}  // namespace

Report reproduce(const ReproductionOptions& options) {
  const std::string& folder = options.folder;
  require_folder(folder);
  if (!options.force && !std::filesystem::is_empty(folder) &&
      !std::filesystem::exists(std::filesystem::path(folder) / kDone))
    throw UsageError(
        fmt::format("-o {}: is not empty and holds no report, so files of yours could be replaced; "
                    "choose another folder, or give --force",
                    folder));
  require_folder(folder + "/data");
  require_folder(folder + "/scenes");
  require_gnuplot();
  // The studies' commands are recorded with file names that are valid inside the folder.
  const InFolder inside(folder);
  const FolderLock lock(folder);
  if (const Json old = read_json("report.json");
      options.quick && old.is_object() && old.value("quick", Json()) == false)
    throw UsageError(fmt::format(
        "{} holds a full report, which --quick would replace; choose another folder", folder));
  require_no_scene_of_ones_own(folder);
  if (!std::filesystem::exists(kDone)) write_text_atomically(kDone, "{}\n");
  const std::vector<Study> studies = paper_studies(options.quick);
  const std::vector<Report::Scene> scenes = write_scenes();
  // An old page must not stand beside new figures if the run stops between them.
  std::filesystem::remove("report.html");
  Report r =
      report_of(carry_out(studies, options.talk, options.each), studies, options.quick, scenes);
  write_text_atomically("claims.csv", csv_of(r.claims));
  write_text_atomically("report.json", result_json([&](Fields& out) { describe(out, r); }, -1));
  if (has_pages()) write_text_atomically("report.html", report_page(r, drawn_figure));
  return r;
}

}  // namespace gatewalk::cli
