// SPDX-License-Identifier: MIT
#include "cli/paper/reproduction.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

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
#include <sstream>

#include "cli/command.h"
#include "cli/paper/figures.h"
#include "cli/paper/page.h"
#include "cli/paper/studies.h"
#include "cli/render/csv.h"
#include "cli/render/figure.h"
#include "cli/render/json.h"
#include "cli/render/provenance.h"
#include "cli/render/text.h"
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

/// Which build this is: a commit alone does not tell two builds of changed sources apart.
std::string build_id() {
  const char* const self = "/proc/self/exe";
  std::error_code error;
  const auto size = std::filesystem::file_size(self, error);
  const auto time = std::filesystem::last_write_time(self, error).time_since_epoch().count();
  return std::string(kVersion) + " " + kCommit + " " + std::to_string(size) + " " +
         std::to_string(time);
}

/// What is known of a study that was carried out: enough to know whether it is still the same one.
Json record_of(const Study& s) { return {{"command", s.text()}, {"program", build_id()}}; }

/// A file of the folder.
std::string file_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Empty when there is none, or none that can be read: then it is made again.
Json read_json(const std::string& path) {
  std::ifstream in(path);
  if (!in) return {};
  Json j = parsed_json(std::string{std::istreambuf_iterator<char>(in), {}});
  return j.is_discarded() ? Json() : j;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm day{};
  ::gmtime_r(&now, &day);
  char text[16];
  std::strftime(text, sizeof text, "%Y-%m-%d", &day);
  return text;
}

/// Throws UsageError when a scene in the working folder, called `folder`, would be replaced that is
/// neither what the program carries nor what an earlier report was made with.
void require_no_scene_of_ones_own(const std::string& folder) {
  const Json old = read_json("report.json");
  const Json made_by = old.is_object() ? old.value("made_by", Json()) : Json();
  const Json scenes = made_by.is_object() ? made_by.value("scenes", Json()) : Json();
  for (const char* name : kScenes) {
    std::ifstream in(name, std::ios::binary);
    if (!in) continue;
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    bool known = text == carried_file(name);
    if (scenes.is_array())
      for (const Json& s : scenes)
        known |=
            s.is_object() && s.value("name", Json()) == name && s.value("text", Json()) == text;
    if (!known)
      throw UsageError("-o " + folder + ": its " + name +
                       " is not the paper's and would be replaced; choose another folder");
  }
}

/// Nobody else works in this folder while it lives.
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

/// Work in a folder, and back from there.
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

/// What the studies gave.
struct Results {
  Findings findings;
  double seconds = 0.0;  // of all of them
};

/// The studies on record. Every finished one is there at once, so a run that is stopped goes on
/// from there; none is while it is made anew.
class Records {
 public:
  Records() : done_(read_json(kDone)) {
    if (!done_.is_object()) done_ = Json::object();
  }

  /// Takes the result of a study. False when it is not done yet, or by another command or program,
  /// or cannot be read any more.
  [[nodiscard]] bool take(const Study& s, Findings& findings) const {
    const auto known = done_.find(s.name);
    if (known == done_.end() || !known->is_object()) return false;
    const Json wanted = record_of(s);
    for (const auto& [key, value] : wanted.items())
      if (known->value(key, Json()) != value) return false;
    if (!known->value("seconds", Json()).is_number()) return false;
    for (auto word = s.arguments.begin(); word != s.arguments.end(); ++word)
      if (*word == "--figure" && !std::filesystem::exists(*(word + 1))) return false;
    try {
      take_file(s, findings);
      return true;
    } catch (const std::exception&) {  // a file of another run, or half a one, is no result
      return false;
    }
  }
  /// Carries a study out, puts it on record and takes its result.
  void make(const Study& s, const dynamics::Work& work, Findings& findings) {
    if (done_.erase(s.name) > 0) write();
    const dynamics::Stopwatch watch;
    const std::string remarks = run(s, work);
    take_file(s, findings);
    done_[s.name] = record_of(s);
    if (!remarks.empty()) done_[s.name]["remarks"] = remarks;
    done_[s.name]["seconds"] = watch.seconds();
    write();
  }
  [[nodiscard]] double seconds(const Study& s) const {
    return done_[s.name]["seconds"].get<double>();
  }
  [[nodiscard]] bool has_remarks(const Study& s) const { return done_[s.name].contains("remarks"); }

 private:
  static std::string file_of(const Study& s) { return "data/" + s.name + ".json"; }
  /// Throws std::exception for a file that is no result of the study.
  static void take_file(const Study& s, Findings& findings) {
    const Json data = read_json(file_of(s));
    (void)data.at("made_by");
    if (s.take) s.take(findings, data);
  }
  /// Returns its remarks: the paper's own scheme shows faults and says so; that belongs to the
  /// study, not to this run.
  static std::string run(const Study& s, const dynamics::Work& work) {
    std::string remarks;
    Arguments arguments = s.arguments;
    arguments.words.insert(arguments.words.end(), {"--quiet", "--force", "--json", file_of(s)});
    arguments.work = work;
    arguments.warned = [&](const std::string& text) { remarks += "gatewalk: " + text + "\n"; };
    if (const int status = s.run(arguments); status != kFine)
      throw std::runtime_error(s.text() + ": ended with status " + std::to_string(status) + ". " +
                               remarks);
    return remarks;
  }
  void write() const { write_text_atomically(kDone, text_of(done_) + "\n"); }

  Json done_;
};

/// Carries out what is not done yet, and takes what all of them gave.
Results carry_out(const std::vector<Study>& studies, bool talk) {
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
    if (talk)
      std::cout << padded(
                       "[" + std::to_string(++number) + "/" + std::to_string(studies.size()) + "]",
                       8)
                << "  " << padded(s->name, -18) << padded(fixed(records.seconds(*s), 1), 7) << " s"
                << (records.has_remarks(*s) ? "   (with remarks: data/done.json)" : "") << "\n"
                << std::flush;
  }
  for (const Study& s : studies) results.seconds += records.seconds(s);
  return results;
}

/// Writes the scenes that the studies name. Returns them as the report has them.
Json write_scenes() {
  Json scenes = Json::array();
  for (const char* scene : kScenes) {
    const std::string text(carried_file(scene));
    write_text_atomically(scene, text);
    scenes.push_back({{"name", scene}, {"text", text}});
  }
  return scenes;
}

/// What the page begins with.
std::vector<std::string> lead_of(const Reproduction& r, bool quick) {
  std::vector<std::string> lead{
      "The results of the paper, Figs. 5, 6, 8, 9, 11, 12 and Table IV, and what its abstract "
      "and its Sections II and III claim, made again from the model alone, beside the paper's "
      "own values.",
      "Of " + std::to_string(r.claims.size()) + " claims: " + r.tally() +
          ". \"Agrees\" means that it deviates by no more than the paper's 100 trials a point "
          "would show (of Table IV: that the printed pair fits only one of two readings of what "
          "was compared, trials with the exact chain or with 100 walks); \"cannot tell\", that "
          "the trials here are too few. Why a claim differs, as far as it is known, stands beside "
          "it. Intervals are 95 % "
          "(Jeffreys).",
      "Symbols as in the paper: F_prop propulsive force, Rm random force (N); k_L, k_R stiffness "
      "of the left and right beam (N m/rad), d their damping (N m s/rad, printed as N s/rad) "
      "and, of a start, the place where it enters (m); RT, LT: entries through the sides above "
      "the joints."};
  if (quick)
    lead.push_back(
        "This is the quick version: few trials, wide intervals. The full one, without --quick, "
        "takes some four minutes.");
  return lead;
}

/// The two pictures that the page begins with: commands of the studies drew them.
Json first_screen(const std::map<std::string, std::string>& commands) {
  return {
      {{"figure", "crossing.svg"},
       {"alt",
        "Twenty paths from the middle of the lower edge into the field, each with a disc where it "
        "ended; of the nine by nine gates only the rows and columns that bodies reached are "
        "drawn."},
       {"caption",
        "Full dynamics: twenty bodies push into the field of 9 x 9 gates; drawn are the rows and "
        "columns that they reached."},
       {"command", commands.at("crossing_ways")}},
      {{"figure", "prediction.svg"},
       {"alt",
        "A map of nine by nine gates coloured by the share of bodies that end in each, and bars "
        "of how they end."},
       {"caption", "Markov chain: in which gate bodies end, and how."},
       {"command", commands.at("prediction")}}};
}

Reproduction report_of(const Results& results, const std::vector<Study>& studies, bool quick,
                       const Json& scenes) {
  std::map<std::string, std::string> commands;
  for (const Study& s : studies) commands[s.name] = s.text();
  Reproduction r{.report = {}, .claims = claims_of(results.findings), .seconds = results.seconds};
  r.report = {{"title", "Cluttered obstacle traversal: what gatewalk reproduces"},
              {"paper",
               "B. Zheng, Q. Xuan and C. Li, A minimalistic stochastic dynamics model of cluttered "
               "obstacle traversal, IEEE Robotics and Automation Letters (2022)"},
              {"quick", quick},
              {"claims", to_json(r.claims)},
              {"lead", lead_of(r, quick)},
              {"first", first_screen(commands)},
              {"sections", sections_of(results.findings, commands)},
              {"made_by",
               {{"program", std::string("gatewalk ") + kVersion + " (" + kCommit + ")"},
                {"command", std::string("gatewalk reproduce") + (quick ? " --quick" : "")},
                {"seed", 1},
                {"machine", machine()},
                {"seconds", results.seconds},
                {"date", today()},
                {"scenes", scenes}}}};
  return r;
}

}  // namespace

std::string Reproduction::tally() const {
  const auto count = [&](Verdict verdict) {
    return std::to_string(std::count_if(claims.begin(), claims.end(),
                                        [&](const Claim& c) { return c.verdict == verdict; }));
  };
  return count(Verdict::reproduced) + " reproduced, " + count(Verdict::agrees) + " agree, " +
         count(Verdict::cannot_tell) + " cannot be told, " + count(Verdict::differs) + " differ";
}

Reproduction reproduce(const ReproductionOptions& options) {
  const std::string& folder = options.folder;
  require_folder(folder);
  if (!options.force && !std::filesystem::is_empty(folder) &&
      !std::filesystem::exists(std::filesystem::path(folder) / kDone))
    throw UsageError("-o " + folder +
                     ": is not empty and holds no report, so files of yours could be replaced; "
                     "choose another folder, or give --force");
  require_folder(folder + "/data");
  require_folder(folder + "/scenes");
  require_gnuplot();
  // The commands are recorded as they work inside the folder.
  const InFolder inside(folder);
  const FolderLock lock(folder);
  if (const Json old = read_json("report.json");
      options.quick && old.is_object() && old.value("quick", Json()) == false)
    throw UsageError(folder +
                     " holds a full report, which --quick would replace; choose another folder");
  require_no_scene_of_ones_own(folder);
  if (!std::filesystem::exists(kDone)) write_text_atomically(kDone, "{}\n");
  const std::vector<Study> studies = paper_studies(options.quick);
  const Json scenes = write_scenes();
  // No old page beside new figures, should this be stopped between them.
  std::filesystem::remove("report.html");
  Reproduction r = report_of(carry_out(studies, options.talk), studies, options.quick, scenes);
  write_text_atomically("claims.csv", csv_of(r.claims));
  write_text_atomically("report.json", json_text(r.report, -1));
  if (has_pages()) write_text_atomically("report.html", report_page(r.report, file_text));
  return r;
}

}  // namespace gatewalk::cli
