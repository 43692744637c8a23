#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "core/archive.h"
#include "python/raised.h"

namespace faba::python {

/// An object or class of Python that C++ code may copy and destroy without the GIL.
class SharedObject {
 public:
  /// The caller has the GIL.
  explicit SharedObject(py::object object) : object_(new py::object(std::move(object)), release) {}
  /// The caller has the GIL.
  const py::object& get() const { return *object_; }

 private:
  static void release(py::object* object);
  std::shared_ptr<py::object> object_;
};

/// "module:Class" of an object or class; the file of a scenario names a part of type "python" like this.
std::string class_name(const py::object& part);

/// A part of the control loop in Python: an instance, and its state for checkpoints.
class PartObject {
 public:
  /// `part`: an instance, or a class, of which an instance is made. `where`: key of the part in the scenario.
  /// Sets `context` and calls start(), if the part has it. Throws what Python code raises, kept in `raised`.
  PartObject(const SharedObject& part, const py::object& context, std::string where,
             std::shared_ptr<Raised> raised);

  /// Calls `work(instance)` with the GIL; an exception is kept and ends the run.
  template <class Work>
  auto call(Work&& work) {
    const py::gil_scoped_acquire gil;
    try {
      return work(instance_->get());
    } catch (const py::error_already_set& e) {
      throw raised_->keep(where_, e);
    } catch (const py::cast_error& e) {
      throw Error(Errc::usage, where_, std::string("a value has an unsuitable type: ") + e.what());
    }
  }
  const std::string& where() const { return where_; }
  /// state() and restore() of the instance. An instance without attributes has no state. Throws Error(usage)
  /// on reading if the part has attributes but not these functions.
  void archive(Archive& a);

 private:
  std::string where_;
  std::shared_ptr<Raised> raised_;
  std::unique_ptr<SharedObject> instance_;
};

}  // namespace faba::python
