// SPDX-License-Identifier: MIT
#pragma once
/// Ctrl-C, SIGTERM, SIGHUP and SIGUSR1. The first signal asks the program to stop at the next safe
/// point, and ends it after a second if none comes; a second signal ends it at once. Files are
/// replaced as a whole, so no stop leaves half a file; an unfinished temporary file is removed.

#include <string>

namespace gatewalk::cli {

/// Messages of a program that stopped between two batches, and of one that was cut short.
inline constexpr char kStoppedText[] =
    "gatewalk: stopped before the end; nothing was written, files that were there are unchanged\n";
inline constexpr char kCutShortText[] =
    "gatewalk: stopped before the end; every file is whole, either as it was or finished\n";

/// Says that finished work is kept in `file`. A run that stops then reports so and exits with
/// status 75 instead of 130. Empty: nothing is kept.
void set_kept_file(const std::string& file);
/// The message and the exit status of a run that stops.
[[nodiscard]] const char* stopped_text() noexcept;
[[nodiscard]] int stopped_status() noexcept;

/// Thrown between two batches of work once interrupted() is true.
struct Interrupted {};

/// From now on SIGINT, SIGTERM, SIGHUP and SIGUSR1 make interrupted() true, unless they were
/// ignored when the program started. A second signal, or a second without a safe point, ends the
/// program with stopped_status().
void install_interrupt_handler();

[[nodiscard]] bool interrupted();

}  // namespace gatewalk::cli
