// SPDX-License-Identifier: MIT
#pragma once
/// A result as Python has it.

#include <pybind11/pybind11.h>

#include "cli/fields/fields.h"

namespace gatewalk::python {

/// A dict of what is described; with the GIL held. Numbers are float, None where they are NaN. An
/// interval is a tuple (low, high). Lists and tables of numbers are numpy arrays of doubles, with
/// NaN; of intervals their last axis is low and high. A list without an element is a list.
[[nodiscard]] pybind11::dict to_python(const cli::Description& describe);

}  // namespace gatewalk::python
