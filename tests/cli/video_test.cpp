// SPDX-License-Identifier: MIT
#include "cli/film/video.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "cli/terminal/child.h"
#include "cli/terminal/interrupt.h"
#include "tests/cli/films.h"

// fontconfig keeps memory to the program's end, which is no leak of ours. Only the address
// sanitizer reads this function.
extern "C" const char* __lsan_default_suppressions() { return "leak:libfontconfig\n"; }

namespace gatewalk::cli {
namespace {

namespace fs = std::filesystem;

class Video : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "gatewalk-video-XXXXXX").string();
    ASSERT_NE(::mkdtemp(name.data()), nullptr);
    folder_ = name;
    path_ = std::getenv("PATH");
  }
  void TearDown() override {
    ::setenv("PATH", path_.c_str(), 1);
    fs::remove_all(folder_);
  }
  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_ / name).string();
  }
  [[nodiscard]] std::ptrdiff_t files() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator{});
  }
  /// Puts a script named ffmpeg into a folder that is the only one in PATH.
  void instead_of_ffmpeg(const std::string& script) {
    fs::create_directory(folder_ / "bin");
    std::ofstream(path("bin/ffmpeg")) << "#!/bin/sh\n" << script << "\n";
    ::chmod(path("bin/ffmpeg").c_str(), 0700);
    ::setenv("PATH", path("bin").c_str(), 1);
  }

  fs::path folder_;
  std::string path_;
};

std::string complaint_of(const std::string& path, const Film& film = small_film(5),
                         const VideoOptions& options = {}) {
  try {
    write_video(path, film, options);
  } catch (const std::exception& e) {
    return e.what();
  }
  return "(written)";
}

std::string bytes_of(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What ffprobe says of a video, a line "name=value" each; it counts the pictures one by one.
std::string probed(const std::string& path) {
  const File nothing = scratch_file();
  Child ffprobe({"ffprobe", "-v", "error", "-count_frames", "-show_streams", "-show_format", path},
                ::fileno(nothing.get()), "ffprobe was not found");
  return ffprobe.output();
}

double number(const std::string& words, const std::string& name) {
  const std::size_t at = words.find("\n" + name + "=");
  return at == words.npos ? -1.0 : std::strtod(words.c_str() + at + name.size() + 2, nullptr);
}

TEST(Film, SaysHowFastItPlays) {
  EXPECT_EQ(speed_words(1.0), "in real time");
  EXPECT_EQ(speed_words(0.25), "at 1/4 of real time");
  EXPECT_EQ(speed_words(1.0 / 3.0), "at 1/3 of real time");
  EXPECT_EQ(speed_words(0.0731), "at 0.0731 of real time");
  EXPECT_EQ(speed_words(4.0), "at 4 times real time");
  // At any speed the first picture shows the same scene, but other words.
  const Film film = small_film();
  const auto first = [&](double speed, bool labels) {
    return video_frame(film, 0.0, {.speed = speed, .labels = labels});
  };
  EXPECT_NE(first(1.0, true), first(0.25, true));
  EXPECT_EQ(first(1.0, false), first(0.25, false));
}

TEST_F(Video, IsOneThatPlaysEverywhere) {
  write_video(path("a.mp4"), small_film());  // 1 s of film, then the last picture for a second
  const std::string words = probed(path("a.mp4"));
  for (const char* fact : {"codec_name=h264", "pix_fmt=yuv420p", "width=1280", "height=720",
                           "r_frame_rate=50/1", "color_space=bt709", "nb_streams=1"})
    EXPECT_NE(words.find(std::string("\n") + fact + "\n"), words.npos) << fact << "\n" << words;
  EXPECT_EQ(number(words, "nb_read_frames"), 101);
  EXPECT_NEAR(number(words, "duration"), 2.02, 0.001);
  const std::string video = bytes_of(path("a.mp4"));
  EXPECT_LT(video.find("moov"), video.find("mdat")) << "plays before all of it is there";
  EXPECT_EQ(files(), 1);
}

TEST_F(Video, IsAGifByTheEndingOfItsName) {
  write_video(path("a.gif"), small_film());
  const std::string words = probed(path("a.gif"));
  for (const char* fact : {"codec_name=gif", "width=800", "height=450"})
    EXPECT_NE(words.find(std::string("\n") + fact + "\n"), words.npos) << fact << "\n" << words;
  EXPECT_NEAR(number(words, "duration"), 2.08, 0.05);  // 1 s, then the last picture
  EXPECT_EQ(complaint_of(path("a.avi")), path("a.avi") + ": a video is FILE.mp4 or FILE.gif");
  EXPECT_EQ(files(), 1);
}

TEST_F(Video, SpeedAndFramesPerSecond) {
  write_video(path("a.mp4"), small_film(), {.speed = 0.5, .frames_per_second = 10.0});
  const std::string words = probed(path("a.mp4"));
  EXPECT_EQ(number(words, "nb_read_frames"), 20 + 1 + 10);
  EXPECT_NEAR(number(words, "duration"), 3.1, 0.001);
}

/// The mean red, green and blue in a box of the picture at a time.
std::array<double, 3> mean_colour(const std::string& path, double time, const std::string& box) {
  const File nothing = scratch_file();
  Child ffmpeg({"ffmpeg", "-v", "error", "-i", path, "-ss", std::to_string(time), "-frames:v", "1",
                "-vf", "crop=" + box, "-f", "rawvideo", "-pix_fmt", "rgb24", "pipe:1"},
               ::fileno(nothing.get()), "ffmpeg was not found");
  const std::string pixels = ffmpeg.output();
  std::array<double, 3> mean{};
  for (std::size_t i = 0; i < pixels.size(); ++i)
    mean[i % 3] += static_cast<unsigned char>(pixels[i]) * 3.0 / static_cast<double>(pixels.size());
  return mean;
}

TEST_F(Video, ShowsTheBodyMovingAndTheBeamsInTheirColours) {
  write_video(path("a.mp4"), small_film());
  // At rest the beams lie across the middle of the stage: blue on the left, red on the right.
  const auto left = mean_colour(path("a.mp4"), 0.0, "60:4:400:327");
  const auto right = mean_colour(path("a.mp4"), 0.0, "60:4:500:327");
  EXPECT_GT(left[2], left[0] + 80) << "left beam";
  EXPECT_GT(right[0], right[2] + 80) << "right beam";
  // The place where the body was at the start is bare ground at the end.
  const std::string start = "20:20:490:590";
  EXPECT_GT(mean_colour(path("a.mp4"), 1.5, start)[0],
            mean_colour(path("a.mp4"), 0.0, start)[0] + 5);
}

/// The number of bytes in which two pictures differ.
std::size_t differing(const std::string& a, const std::string& b) {
  EXPECT_EQ(a.size(), b.size());
  std::size_t n = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) n += a[i] != b[i];
  return n;
}

// In other units the pictures are the same, point by point, except for words and numbers.
TEST_F(Video, ASceneInOtherUnitsLooksTheSame) {
  for (const Film& film : {small_film(100), small_field_film()}) {
    const double end = film.runs[0].steps.back().time;
    std::vector<Film> twins;
    for (const test::Twin& twin : kOtherUnits) twins.push_back(in_other_units(film, twin));
    for (const double part : {0.0, 0.34, 0.62}) {  // before a hit, just after it, and later
      const VideoOptions bare{.labels = false};
      const std::string paper = video_frame(film, part * end, bare);
      ASSERT_EQ(paper.size(), 1280u * 720u * 4u);
      EXPECT_GT(differing(paper, video_frame(film, part * end)), 1000u) << "labels are seen";
      EXPECT_GT(differing(paper, video_frame(film, (part + 0.05) * end, bare)), 1000u)
          << "it moves";
      for (std::size_t i = 0; i < twins.size(); ++i)
        EXPECT_EQ(
            differing(paper, video_frame(twins[i], part * end * kOtherUnits[i].of(0, 1, 0), bare)),
            0u)
            << "twin " << i << " at " << part;
    }
  }
}

// By default a film takes as long as in the scene's own units; `speed` overrides this.
TEST_F(Video, PaceIsTheScenes) {
  const test::Twin slow{.time = -5};
  const Film film = in_other_units(small_film(), slow);
  write_video(path("a.mp4"), film);
  EXPECT_EQ(number(probed(path("a.mp4")), "nb_read_frames"), 101);
  write_video(path("b.mp4"), film, {.speed = 0.5 * slow.of(0, 1, 0)});
  EXPECT_EQ(number(probed(path("b.mp4")), "nb_read_frames"), 151);
}

TEST_F(Video, MissingFfmpegIsSaidAndLeavesNothing) {
  ::setenv("PATH", "/nonexistent", 1);
  EXPECT_EQ(complaint_of(path("a.mp4")),
            "ffmpeg was not found; it packs the video (Debian: ffmpeg)");
  EXPECT_EQ(files(), 0);
}

TEST_F(Video, FailuresCarryFfmpegsWordsAndLeaveTheOldFile) {
  std::ofstream(path("a.mp4")) << "old";
  instead_of_ffmpeg("echo no disk, no film >&2; exit 3");
  // Enough pictures for ffmpeg to end in the middle of them.
  EXPECT_EQ(complaint_of(path("a.mp4"), small_film(50)), "ffmpeg failed: no disk, no film");
  EXPECT_EQ(bytes_of(path("a.mp4")), "old");
  instead_of_ffmpeg("exit 0");
  EXPECT_EQ(complaint_of(path("a.mp4"), small_film(50)), "ffmpeg stopped reading before the end");
  EXPECT_EQ(bytes_of(path("a.mp4")), "old");
  EXPECT_EQ(files(), 2) << "a.mp4 and bin";
}

TEST_F(Video, AFileThatCannotBeWrittenIsSaidAtOnce) {
  ::setenv("PATH", "/nonexistent", 1);  // the error comes before ffmpeg is looked for
  EXPECT_NE(complaint_of(path("none/a.mp4")).find("No such file or directory"), std::string::npos);
}

TEST_F(Video, RefusesAFilmThatMakesNoSense) {
  Film film = small_film(5);
  film.runs[0].steps[2].body.vy = std::nan("");
  EXPECT_EQ(complaint_of(path("a.mp4"), film), "film: a step holds what is no number");
  film = small_film(5);
  film.runs[0].steps[1].time = 7.0;
  EXPECT_EQ(complaint_of(path("a.mp4"), film), "film: its time goes back");
  film.runs[0].steps.clear();
  EXPECT_EQ(complaint_of(path("a.mp4"), film), "film: a run without steps");
  film.runs.clear();
  EXPECT_EQ(complaint_of(path("a.mp4"), film), "film: without runs");
  for (const double speed : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(complaint_of(path("a.mp4"), small_film(5), {.speed = speed}),
              "a video's speed must be above 0");
  EXPECT_EQ(complaint_of(path("a.mp4"), small_film(5), {.frames_per_second = 0.0}),
            "a video has 1 to 240 frames a second");
  EXPECT_EQ(files(), 0);
}

using VideoDeathTest = Video;

TEST_F(VideoDeathTest, CtrlCEndsItAndLeavesNothing) {
  // One ffmpeg reads nothing, the other does not end.
  for (const char* script : {"exec /bin/sleep 60", "/bin/cat >/dev/null; exec /bin/sleep 60"}) {
    instead_of_ffmpeg(script);
    EXPECT_EXIT(
        {
          install_interrupt_handler();
          std::thread([] {
            std::this_thread::sleep_for(std::chrono::seconds(2));
            ::kill(::getpid(), SIGINT);
          }).detach();
          try {
            write_video(path("a.mp4"), small_film(5));
          } catch (const Interrupted&) {
            ::_exit(7);
          }
          ::_exit(1);
        },
        testing::ExitedWithCode(7), "");
    EXPECT_EQ(files(), 1) << "bin";
  }
}

}  // namespace
}  // namespace gatewalk::cli
