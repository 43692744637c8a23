#pragma once
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "core/archive.h"
#include "core/monotonic.h"
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

/// The time of a call, from its construction; with the time that other threads of Python hold the GIL.
class CallTime {
 public:
  CallTime(const std::string& where, const Raised& raised) : where_(where), longest_(raised.longest_call) {}
  /// Throws Error(device) if the call took longer than permitted.
  void check() const;

 private:
  const std::string& where_;
  double longest_;  ///< s
  double start_ = monotonic_now();
};

/// A part of the control loop in Python: an instance, and its state for checkpoints.
class PartObject {
 public:
  /// `part`: an instance, or a class, of which an instance is made. `where`: key of the part in the scenario.
  /// Sets `context` and calls start(), if the part has it. Throws what Python code raises, kept in `raised`.
  PartObject(const SharedObject& part, const py::object& context, std::string where,
             std::shared_ptr<Raised> raised);

  /// Calls `work(instance)` with the GIL; an exception, or a call that takes too long, ends the run.
  template <class Work>
  auto call(Work&& work) {
    const CallTime time(where_, *raised_);
    const py::gil_scoped_acquire gil;
    try {
      if constexpr (std::is_void_v<std::invoke_result_t<Work, const py::object&>>) {
        work(instance_->get());
      } else {
        auto result = work(instance_->get());
        time.check();
        return result;
      }
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
