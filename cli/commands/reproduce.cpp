#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

#include "cli/command.h"
#include "cli/paper/page.h"
#include "cli/paper/studies.h"
#include "cli/render/drawing.h"
#include "cli/render/gnuplot.h"
#include "cli/render/report.h"
#include "cli/terminal/interrupt.h"
#include "cli/terminal/output.h"
#include "cli/terminal/progress.h"
#include "cli/version.h"
#include "cli/web/embedded.h"

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

/// Empty when there is none, or none that can be read: then it is made again.
Json read_json(const std::string& path) {
  std::ifstream in(path);
  if (!in) return {};
  Json j = Json::parse(in, nullptr, false);
  return j.is_discarded() ? Json() : j;
}

/// While it lives, what is written to a stream is kept instead.
class Overheard {
 public:
  explicit Overheard(std::ostream& stream) : stream_(stream), usual_(stream.rdbuf(kept_.rdbuf())) {}
  ~Overheard() { stream_.rdbuf(usual_); }
  Overheard(const Overheard&) = delete;
  Overheard& operator=(const Overheard&) = delete;
  [[nodiscard]] std::string text() const { return kept_.str(); }

 private:
  std::ostringstream kept_;
  std::ostream& stream_;
  std::streambuf* usual_;
};

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
class Claim {
 public:
  explicit Claim(const std::string& folder) : fd_(::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (fd_ < 0 || ::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      const int error = errno;
      if (fd_ >= 0) ::close(fd_);
      throw std::runtime_error(folder + (error == EWOULDBLOCK
                                             ? ": another gatewalk reproduce works in it"
                                             : std::string(": ") + std::strerror(error)));
    }
  }
  ~Claim() { ::close(fd_); }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  int fd_;
};

/// Carries out what is not done yet, or cannot be read any more, and takes what all of them gave.
/// Every finished study is on record at once, so a run that is stopped goes on from there; none is
/// on record while it is made anew. Returns their seconds.
double carry_out(const std::vector<Study>& studies, bool talk, Findings& f) {
  Json done = read_json(kDone);
  if (!done.is_object()) done = Json::object();
  std::vector<const Study*> left;
  std::int64_t cost = 0;
  for (const Study& s : studies) {
    f.commands[s.name] = s.text();
    const auto known = done.find(s.name);
    const Json wanted = record_of(s);
    const bool same = known != done.end() && known->is_object() &&
                      known->value("command", Json()) == wanted["command"] &&
                      known->value("program", Json()) == wanted["program"] &&
                      known->value("seconds", Json()).is_number();
    Json data = same ? read_json("data/" + s.name + ".json") : Json();
    // A file of another run, or half a one, is no result.
    const bool whole = data.is_object() && data.contains("made_by");
    if (whole) {
      f.data[s.name] = std::move(data);
    } else {
      left.push_back(&s);
      cost += s.cost;
    }
  }
  const std::size_t before = studies.size() - left.size();
  if (talk && before > 0)
    std::cout << before << " of " << studies.size() << " studies are done already\n" << std::flush;
  Progress progress("studies", cost, talk);
  std::size_t number = before;
  for (const Study* study : left) {
    const Study& s = *study;
    if (interrupted()) throw Interrupted{};
    progress.begin_part(s.name, s.cost);
    if (done.erase(s.name) > 0) write_text_atomically(kDone, text_of(done) + "\n");
    const std::string file = "data/" + s.name + ".json";
    std::vector<std::string> arguments = s.arguments;
    arguments.insert(arguments.end(), {"--quiet", "--json", file});
    const Stopwatch watch;
    std::string remarks;
    {
      // The paper's own scheme shows faults and says so; that belongs to the study, not to this
      // run.
      const Overheard words(std::cerr);
      const int status = s.run(arguments);
      remarks = words.text();
      if (status != kFine)
        throw std::runtime_error(s.text() + ": ended with status " + std::to_string(status) + ". " +
                                 remarks);
    }
    f.data[s.name] = read_json(file);
    if (f.data[s.name].is_null()) throw std::runtime_error(file + ": cannot be read again");
    done[s.name] = record_of(s);
    if (!remarks.empty()) done[s.name]["remarks"] = remarks;
    done[s.name]["seconds"] = watch.seconds();
    write_text_atomically(kDone, text_of(done) + "\n");
    progress.finish();
    if (talk)
      std::cout << padded(
                       "[" + std::to_string(++number) + "/" + std::to_string(studies.size()) + "]",
                       8)
                << "  " << padded(s.name, -18) << padded(fixed(watch.seconds(), 1), 7) << " s"
                << (remarks.empty() ? "" : "   (with remarks: data/done.json)") << "\n"
                << std::flush;
  }
  double seconds = 0.0;
  for (const Study& s : studies) seconds += done[s.name]["seconds"].get<double>();
  return seconds;
}

std::string claims_csv(const Json& claims) {
  std::string text = "id,where,claim,paper,ours,verdict,why,see\n";
  for (const Json& c : claims) {
    std::string row;
    for (const auto& [key, value] : c.items())
      row += (row.empty() ? "" : ",") + csv_text(value.get<std::string>());
    text += row + "\n";
  }
  return text;
}

std::string claims_table(const Json& claims) {
  std::string text;
  for (const Json& c : claims)
    text += padded(c["verdict"].get<std::string>(), -13) + c["claim"].get<std::string>() + " (" +
            c["where"].get<std::string>() + ")\n" + padded("", -13) +
            "paper: " + c["paper"].get<std::string>() + "; here: " + c["ours"].get<std::string>() +
            "\n";
  return text;
}

}  // namespace

int run_reproduce(const std::vector<std::string>& arguments) {
  Options options("reproduce -o DIR [options]",
                  "Everything of the paper: runs the studies behind its figures, tables and "
                  "numbers, sets each claim beside\n"
                  "what was found, with intervals and a verdict, and writes CSV, SVG and PDF of "
                  "every figure and one page,\n"
                  "report.html, that needs no network. A run that was stopped goes on where it was "
                  "when started again.",
                  "gatewalk reproduce -o paper --quick");
  options.without_scene("the studies have scenes of their own, written to DIR/scenes");
  options.output_folder("folder to write to", {"report.html", "report.json", "claims.csv"});
  options.add()("quick", "fewer trials: half a minute on two cores instead of four");
  if (!options.parse(arguments)) return kFine;
  const std::string folder = options.text("output");
  if (options.has("json") && options.text("json") != "-")
    throw UsageError("--json takes only - here: DIR/report.json is written anyway");
  const bool quick = options.has("quick");
  require_folder(folder);
  require_folder(folder + "/data");
  require_folder(folder + "/scenes");
  (void)drawn("print 'gnuplot is there'");  // before minutes of work, not after
  // The commands are recorded as they work inside the folder.
  std::filesystem::current_path(folder);
  const Claim claim(folder);
  if (const Json old = read_json("report.json");
      quick && old.is_object() && old.value("quick", Json()) == false)
    throw UsageError(folder +
                     " holds a full report, which --quick would replace; choose another folder");
  require_no_scene_of_ones_own(folder);
  const std::vector<Study> studies = paper_studies(quick);
  Json scenes = Json::array();
  for (const char* scene : kScenes) {
    const std::string text(carried_file(scene));
    write_text_atomically(scene, text);
    scenes.push_back({{"name", scene}, {"text", text}});
  }

  Findings f;
  try {
    const double seconds = carry_out(studies, options.talk(), f);
    Json report;
    report["title"] = "Cluttered obstacle traversal: what gatewalk reproduces";
    report["paper"] =
        "B. Zheng, Q. Xuan and C. Li, A minimalistic stochastic dynamics model of cluttered "
        "obstacle traversal, IEEE Robotics and Automation Letters (2022)";
    report["quick"] = quick;
    report["claims"] = claims_of(f);
    std::map<std::string, int> verdicts;
    for (const Json& c : report["claims"]) ++verdicts[c["verdict"]];
    report["lead"] = {
        "The results of the paper, Figs. 5, 6, 8, 9, 11, 12 and Table IV, and what its abstract "
        "and its Sections II and III claim, made again from the model alone, beside the paper's "
        "own values.",
        "Of " + std::to_string(report["claims"].size()) + " claims " +
            std::to_string(verdicts["reproduced"]) + " are reproduced, " +
            std::to_string(verdicts["within noise"]) +
            " agree or differ by no more than the paper's 100 trials (or the trials here) can "
            "tell, and " +
            std::to_string(verdicts["differs"]) +
            " differ; why, as far as it is known, stands beside them. Intervals are 95 % "
            "(Jeffreys)."};
    report["lead"].push_back(
        "Symbols as in the paper: F_prop propulsive force, Rm random force (N); k_L, k_R stiffness "
        "of the left and right beam (N m/rad), d their damping (N m s/rad, printed as N s/rad) "
        "and, of a start, the place where it enters (m); RT, LT: entries through the sides above "
        "the joints.");
    if (quick)
      report["lead"].push_back(
          "This is the quick version: few trials, wide intervals. The full one, without --quick, "
          "takes some four minutes.");
    report["sections"] = sections_of(f);
    report["made_by"] = {{"program", std::string("gatewalk ") + kVersion + " (" + kCommit + ")"},
                         {"command", std::string("gatewalk reproduce") + (quick ? " --quick" : "")},
                         {"seed", 1},
                         {"machine", machine()},
                         {"seconds", seconds},
                         {"date", today()},
                         {"scenes", scenes}};
    write_text_atomically("claims.csv", claims_csv(report["claims"]));
    write_text_atomically("report.json", text_of(report, -1) + "\n");
    write_text_atomically("report.html", report_page(report));
    if (options.has("json"))
      options.give_out(report, "", -1);
    else if (options.talk())
      std::cout << "\n"
                << claims_table(report["claims"]) << "\n"
                << verdicts["reproduced"] << " reproduced, " << verdicts["within noise"]
                << " within noise, " << verdicts["differs"] << " differ. Studies "
                << fixed(seconds, 0) << " s. Open " << folder << "/report.html\n"
                << std::flush;
  } catch (const Interrupted&) {
    std::cerr << "gatewalk: stopped before the end; what was finished stays in " << folder
              << ", the same command goes on from there\n";
    return kStopped;
  }
  return kFine;
}

}  // namespace gatewalk::cli
