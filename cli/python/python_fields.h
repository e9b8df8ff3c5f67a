// SPDX-License-Identifier: MIT
#pragma once
/// A result as Python objects.

#include <pybind11/pybind11.h>

#include "cli/fields/fields.h"

namespace gatewalk::python {

/// A result as a dict; needs the GIL. Numbers are float, None if they are NaN. An interval is a
/// tuple (low, high). Lists and tables of numbers are numpy arrays of doubles, with NaN; for
/// intervals the last axis is low and high. An empty list is a list.
[[nodiscard]] pybind11::dict to_python(const cli::Description& describe);

}  // namespace gatewalk::python
