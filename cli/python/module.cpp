// SPDX-License-Identifier: MIT
// The Python module gatewalk._core: commands by their words, and matrices.

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <tbb/global_control.h>

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string_view>

#include "cli/commands.h"
#include "cli/exchange/sparse_table.h"
#include "cli/fields/schema.h"
#include "cli/python/python_cell.h"
#include "cli/python/python_fields.h"
#include "cli/render/version.h"
#include "dynamics/cells/check_cell.h"
#include "lattice/scene/scene.h"
#include "lattice/source/source.h"
#include "lattice/source/source_file.h"

namespace gatewalk::python {
namespace {

namespace py = pybind11;

/// Admits one command at a time, because NetCDF files are read and written by one thread, and a
/// command belongs to its process. A waiting thread hears Ctrl-C. A forked process has its own
/// turn.
class Turn {
 public:
  /// Needs the GIL. Throws UsageError if called within a command.
  Turn() {
    if (is_mine_ || is_in_cell())
      throw cli::UsageError(
          "a command cannot be called while another one calls: from pass_ of a "
          "cell, or from progress");
    static pid_t owner = ::getpid();
    static auto* mutex = new std::timed_mutex;  // never destroyed: threads may wait at the end
    if (owner != ::getpid()) {
      owner = ::getpid();
      mutex = new std::timed_mutex;
    }
    mutex_ = mutex;
    for (bool taken = false; !taken;) {
      {
        const py::gil_scoped_release no_gil;
        taken = mutex_->try_lock_for(std::chrono::milliseconds(50));
      }
      if (!taken && PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    is_mine_ = true;
  }
  ~Turn() {
    is_mine_ = false;
    mutex_->unlock();
  }
  Turn(const Turn&) = delete;
  Turn& operator=(const Turn&) = delete;

 private:
  static thread_local bool is_mine_;
  std::timed_mutex* mutex_ = nullptr;
};
thread_local bool Turn::is_mine_ = false;

/// The content of a matrix file. Python's arrays are views of it.
class Matrix {
 public:
  explicit Matrix(const std::string& path)
      : source_([&] {
          const Turn turn;
          lattice::SourceFile source(path);
          source.keep_in_memory();
          return std::make_shared<const lattice::SourceFile>(std::move(source));
        }()) {
    add("", file().transitions);
    for (const auto& [name, transitions] : file().types) add(name, transitions);
  }
  [[nodiscard]] const std::shared_ptr<const lattice::SourceFile>& source() const { return source_; }
  [[nodiscard]] std::vector<std::string> types() const {
    std::vector<std::string> names;
    for (const auto& [name, type] : types_) names.push_back(name);
    return names;
  }
  [[nodiscard]] const std::map<std::string, std::string>& text() const { return file().text; }

  /// (data, indices, indptr, shape) of the counts or probabilities, in compressed rows.
  static py::tuple csr(const py::object& self, const std::string& type, bool probabilities) {
    const auto& matrix = self.cast<const Matrix&>();
    const auto found = matrix.types_.find(type);
    if (found == matrix.types_.end()) throw py::key_error("the matrix has no type '" + type + "'");
    const auto of = [&](const auto& m) {
      using Value = std::decay_t<decltype(*m.valuePtr())>;
      const auto rows = static_cast<py::ssize_t>(m.rows());
      const auto read_only = [&](auto array) {
        array.attr("flags").attr("writeable") = false;
        return array;
      };
      return py::make_tuple(
          read_only(py::array_t<Value>(static_cast<py::ssize_t>(m.nonZeros()), m.valuePtr(), self)),
          read_only(
              py::array_t<int>(static_cast<py::ssize_t>(m.nonZeros()), m.innerIndexPtr(), self)),
          read_only(py::array_t<int>(rows + 1, m.outerIndexPtr(), self)),
          py::make_tuple(rows, static_cast<py::ssize_t>(m.cols())));
    };
    return probabilities ? of(found->second.probabilities) : of(found->second.counts);
  }
  /// The states in the order of csr()'s rows and columns: names (if they have any), faces, and the
  /// low and high of each coordinate.
  [[nodiscard]] py::dict states() const {
    const dynamics::StateSpace& space = file().transitions.space;
    const auto n = static_cast<py::ssize_t>(space.size());
    const std::vector<int> order = lattice::shown_order(space);
    py::dict all;
    py::list names, faces;
    for (const int s : order) {
      if (!file().state_names.empty())
        names.append(file().state_names[static_cast<std::size_t>(s)]);
      faces.append(space.section().faces[static_cast<std::size_t>(space.face(s))].name);
    }
    if (!names.empty()) all["name"] = names;
    all["face"] = faces;
    for (std::size_t c = 0; c < space.section().coordinates.size(); ++c)
      for (const int side : {0, 1}) {
        py::array_t<double> values(n);
        for (int k = 0; k < space.size(); ++k)
          values.mutable_data()[k] =
              space.range(order[static_cast<std::size_t>(k)]).at[c][static_cast<std::size_t>(side)];
        all[py::str(space.section().coordinates[c].key + (side == 0 ? "_low" : "_high"))] = values;
      }
    return all;
  }
  /// For each face: its name, and the move by which bodies enter through it.
  [[nodiscard]] py::list faces() const {
    py::list all;
    for (const dynamics::Face& f : file().transitions.space.section().faces)
      all.append(py::make_tuple(f.name, f.di_x, f.di_y));
    return all;
  }

 private:
  struct Type {
    markov::Counts counts;
    markov::Probabilities probabilities;
  };
  [[nodiscard]] const lattice::MatrixFile& file() const { return *source_->matrix(); }
  void add(const std::string& name, const dynamics::Transitions& t) {
    const std::vector<int> order = lattice::shown_order(t.space);
    types_.emplace(name, Type{cli::in_order(t.counts(), order),
                              cli::in_order(lattice::make_chain(t).matrix(), order)});
  }
  std::shared_ptr<const lattice::SourceFile> source_;
  std::map<std::string, Type> types_;  // "": the first, or only one
};

const cli::Command& command_of(const std::string& name) {
  const cli::Command* const command = cli::command_named(name);
  if (!command) throw cli::UsageError("there is no command '" + name + "'");
  return *command;
}

/// For each option of a command: name, value as shown, kind, whether it is a file, whether it may
/// be repeated.
py::list options(const std::string& name) {
  py::list all;
  cli::Arguments arguments{};
  arguments.helped = [&](const cli::CommandHelp& help) {
    for (const cli::CommandHelp::Option& o : help.options)
      all.append(py::make_tuple(o.name, o.value, o.kind, o.is_file, o.is_repeated));
  };
  (void)command_of(name).run(arguments);
  return all;
}

py::tuple run(const std::string& name, std::vector<std::string> words, const py::object& told,
              const py::object& warned, const py::object& cell,
              const std::vector<const Matrix*>& matrices) {
  const cli::Command& command = command_of(name);
  py::object result = py::none();
  cli::Arguments arguments(std::move(words));
  arguments.work =
      dynamics::Work{[&](std::string_view what, std::int64_t done, std::int64_t total) {
                       const py::gil_scoped_acquire gil;
                       if (PyErr_CheckSignals() != 0) throw py::error_already_set();
                       if (!told.is_none()) told(std::string(what), done, total);
                     },
                     nullptr, nullptr};
  arguments.warned = [&](const std::string& text) {
    const py::gil_scoped_acquire gil;
    warned(text);
  };
  arguments.given_out = [&](const cli::Description& describe) {
    const py::gil_scoped_acquire gil;
    result = to_python(describe);
  };
  if (!cell.is_none()) arguments.cell = std::make_shared<PythonCell>(cell);
  for (const Matrix* matrix : matrices) arguments.files.push_back(matrix->source());
  int status = 0;
  {
    const Turn turn;
    const py::gil_scoped_release no_gil;
    status = command.run(arguments);
  }
  return py::make_tuple(status, result);
}

/// The keys of a command's results: the name of each list, and its keys with type, unit, meaning
/// and whether all results have them.
py::list result_keys(const std::string& command) {
  py::list all;
  for (const cli::ResultOf& of : cli::results()) {
    if (of.command != command) continue;
    for (const cli::KeyList& list : cli::keys_of(of)) {
      py::list keys;
      for (const cli::KeyLine& k : list.keys)
        keys.append(py::make_tuple(k.path, k.type, k.unit, k.meaning, k.is_always_there));
      all.append(py::make_tuple(list.name, keys));
    }
  }
  return all;
}

/// What is wrong with a cell, tested from these starts (face, coordinates).
std::vector<std::string> check_cell(const py::object& cell,
                                    const std::vector<std::pair<int, std::vector<double>>>& starts,
                                    std::int64_t trials, int cells, std::uint64_t seed) {
  const PythonCell checked(cell);
  std::vector<dynamics::Entry> entries;
  for (const auto& [face, at] : starts) {
    dynamics::Entry& entry = entries.emplace_back();
    entry.face = face;
    std::copy_n(at.begin(), std::min(at.size(), entry.at.size()), entry.at.begin());
  }
  const Turn turn;
  const py::gil_scoped_release no_gil;
  return dynamics::check_cell(checked, entries, {.trials = trials, .cells = cells, .seed = seed});
}

}  // namespace
}  // namespace gatewalk::python

PYBIND11_MODULE(_core, m) {
  using namespace gatewalk;
  using python::Matrix;
  m.doc() = "The C++ part of the module gatewalk, which is documented there.";
  m.attr("version") = cli::kVersion;
  m.attr("commit") = cli::kCommit;
  const auto error = [&](auto tag, const char* name, PyObject* base) {
    return pybind11::register_exception<typename decltype(tag)::type>(m, name, base);
  };
  error(std::common_type<lattice::SceneError>(), "SceneError", PyExc_ValueError);
  error(std::common_type<markov::BadFile>(), "BadFile", PyExc_ValueError);
  static PyObject* const usage_error =
      error(std::common_type<cli::UsageError>(), "UsageError", PyExc_ValueError).release().ptr();
  // Wrong use gives the same messages as in main().
  pybind11::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::invalid_argument& e) {
      PyErr_SetString(usage_error, e.what());
    }
  });
  m.def("run", &python::run, pybind11::arg("command"), pybind11::arg("words"), pybind11::kw_only(),
        pybind11::arg("told"), pybind11::arg("warned"), pybind11::arg("cell"),
        pybind11::arg("matrices"),
        "Runs a command with these words of a command line. Returns (exit status, result as a "
        "dict). The command calls told(what, done, total) with its progress and warned(text) with "
        "each warning. It does not read the files of `matrices` again.");
  m.def("result_keys", &python::result_keys, pybind11::arg("command"),
        "Keys of the results of a command: [(command or shared object, [(key, type, unit, "
        "meaning, always there)])].");
  m.def("options", &python::options, pybind11::arg("command"),
        "Options of a command: [(name, value as shown, kind, is a file, may be repeated)].");
  m.def("check_cell", &python::check_cell, pybind11::arg("cell"), pybind11::arg("starts"),
        pybind11::arg("trials"), pybind11::arg("cells"), pybind11::arg("seed"),
        "Tests a cell with trials from starts [(face, coordinates)]. Returns a sentence for each "
        "fault.");
  m.def(
      "threads",
      [](int n) {
        static std::unique_ptr<tbb::global_control> limit;
        if (n < 0) throw cli::UsageError("threads: must not be negative");
        limit.reset();
        if (n > 0)
          limit = std::make_unique<tbb::global_control>(
              tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(n));
      },
      pybind11::arg("n"), "Sets the number of threads for all commands that follow; 0: all.");
  pybind11::class_<Matrix>(m, "Matrix", "The content of a matrix file.")
      .def(pybind11::init<std::string>(), pybind11::arg("path"))
      .def_property_readonly("types", &Matrix::types,
                             "Names of the types of gates; '' is the first type.")
      .def_property_readonly("text", &Matrix::text,
                             "Texts of the file: scene, seed, version, command.")
      .def("csr", &Matrix::csr, pybind11::arg("type"), pybind11::arg("probabilities"),
           "Returns (data, indices, indptr, shape); the arrays are views of the matrix.")
      .def("states", &Matrix::states,
           "A dict of columns with a value for each state: its name (if states have names), its "
           "face, and low and high of each coordinate.")
      .def("faces", &Matrix::faces,
           "A list of (name, di_x, di_y), the move into a cell by each face.");
}
