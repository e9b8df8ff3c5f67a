#pragma once
/// Ctrl-C and SIGTERM: the first asks to stop at the next safe point, the second ends at once.

namespace gatewalk::cli {

/// Thrown between two batches of work once interrupted() is true.
struct Interrupted {};

/// From now on SIGINT and SIGTERM make interrupted() true; a second one ends with status 130.
void install_interrupt_handler();

[[nodiscard]] bool interrupted();

}  // namespace gatewalk::cli
