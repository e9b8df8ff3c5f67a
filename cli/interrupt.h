#pragma once
/// Ctrl-C and SIGTERM: the first asks to stop at the next safe point and ends after a second if none
/// comes, the second ends at once. Files are replaced in one go, so an end at any time harms none.

namespace gatewalk::cli {

/// What a program says that was stopped between two batches, and one that was cut short.
inline constexpr char kStoppedText[] =
    "gatewalk: stopped before the end; nothing was written, files that were there are unchanged\n";
inline constexpr char kCutShortText[] =
    "gatewalk: stopped before the end; every file is whole, either as it was or finished\n";

/// Thrown between two batches of work once interrupted() is true.
struct Interrupted {};

/// From now on SIGINT and SIGTERM make interrupted() true; a second one, or a second without
/// a safe point, ends with status 130.
void install_interrupt_handler();

[[nodiscard]] bool interrupted();

}  // namespace gatewalk::cli
