#pragma once
/// Ctrl-C, SIGTERM and SIGHUP: the first asks to stop at the next safe point and ends after a
/// second if none comes, the second ends at once. Files are replaced in one go, so an end at any
/// time harms none; a temporary file under way is removed.

namespace gatewalk::cli {

/// What a program says that was stopped between two batches, and one that was cut short.
inline constexpr char kStoppedText[] =
    "gatewalk: stopped before the end; nothing was written, files that were there are unchanged\n";
inline constexpr char kCutShortText[] =
    "gatewalk: stopped before the end; every file is whole, either as it was or finished\n";

/// Thrown between two batches of work once interrupted() is true.
struct Interrupted {};

/// From now on SIGINT, SIGTERM and SIGHUP make interrupted() true, unless they were ignored when
/// the program started; a second one, or a second without a safe point, ends with status 130.
void install_interrupt_handler();

[[nodiscard]] bool interrupted();

}  // namespace gatewalk::cli
