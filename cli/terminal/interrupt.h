// SPDX-License-Identifier: MIT
#pragma once
/// Ctrl-C, SIGTERM, SIGHUP and SIGUSR1: the first asks to stop at the next safe point and ends
/// after a second if none comes, the second ends at once. Files are replaced in one go, so an end
/// at any time harms none; a temporary file under way is removed.

#include <string>

namespace gatewalk::cli {

/// What a program says that was stopped between two batches, and one that was cut short.
inline constexpr char kStoppedText[] =
    "gatewalk: stopped before the end; nothing was written, files that were there are unchanged\n";
inline constexpr char kCutShortText[] =
    "gatewalk: stopped before the end; every file is whole, either as it was or finished\n";

/// What is done is kept in `file`: a run that stops says so, with status 75 instead of 130. Empty:
/// nothing is kept.
void set_kept_file(const std::string& file);
/// What a run says that stops, a line; and its exit status.
[[nodiscard]] const char* stopped_text() noexcept;
[[nodiscard]] int stopped_status() noexcept;

/// Thrown between two batches of work once interrupted() is true.
struct Interrupted {};

/// From now on SIGINT, SIGTERM, SIGHUP and SIGUSR1 make interrupted() true, unless they were
/// ignored when the program started; a second one, or a second without a safe point, ends with the
/// status of a stop.
void install_interrupt_handler();

[[nodiscard]] bool interrupted();

}  // namespace gatewalk::cli
