#include "python/python_object.h"

#include <fmt/format.h>

namespace faba::python {
namespace {

constexpr const char* kNoState = "no state()";  // in a checkpoint; not JSON

// Whether an instance can remember something: attributes other than those that Faba sets.
bool has_memory(const py::object& instance) {
  if (!py::hasattr(instance, "__dict__")) return true;
  for (const auto& [name, value] : py::dict(instance.attr("__dict__")))
    if (name.cast<std::string>() != "context") return true;
  return false;
}

}  // namespace

void SharedObject::release(py::object* object) {
  if (!Py_IsInitialized()) return;  // the interpreter has ended with all its objects
  const py::gil_scoped_acquire gil;
  delete object;
}

void CallTime::check() const {
  const double taken = monotonic_now() - start_;
  if (taken <= longest_) return;
  throw Error(
      Errc::device, where_,
      fmt::format("a call took {:.3g} s, but the guard of the bench waits {:.3g} s for a command and has "
                  "de-energised the coils; make it faster, or increase rig.guard.command_deadline",
                  taken, longest_));
}

std::string class_name(const py::object& part) {
  const py::object type = py::isinstance<py::type>(part) ? part : py::object(py::type::of(part));
  return fmt::format("{}:{}", py::str(type.attr("__module__")).cast<std::string>(),
                     py::str(type.attr("__qualname__")).cast<std::string>());
}

PartObject::PartObject(const SharedObject& part, const py::object& context, std::string where,
                       std::shared_ptr<Raised> raised)
    : where_(std::move(where)), raised_(std::move(raised)) {
  const py::gil_scoped_acquire gil;
  try {
    py::object instance = part.get();
    if (py::isinstance<py::type>(instance)) instance = instance();
    if (!py::hasattr(instance, "update"))
      throw Error(
          Errc::usage, where_,
          fmt::format("{} has no function update(); derive it from faba.Controller, faba.Estimator or "
                      "faba.Reference",
                      class_name(instance)));
    instance.attr("context") = context;
    if (py::hasattr(instance, "start")) instance.attr("start")();
    instance_ = std::make_unique<SharedObject>(std::move(instance));
  } catch (const py::error_already_set& e) {
    throw raised_->keep(where_, e);
  }
}

void PartObject::archive(Archive& a) {
  call([&](const py::object& instance) {
    const bool stores = py::hasattr(instance, "state") && py::hasattr(instance, "restore");
    const py::module_ json = py::module_::import("json");
    std::string text;
    if (!a.reading())
      text = stores                 ? json.attr("dumps")(instance.attr("state")()).cast<std::string>()
             : has_memory(instance) ? kNoState
                                    : "";
    a& text;
    if (!a.reading()) return;
    if (text == kNoState || text.empty() == stores)
      throw Error(
          Errc::usage, where_,
          fmt::format("{} keeps values in attributes, but has no functions state() and restore(), or "
                      "did not have them when the run was recorded; a run with it can only be started "
                      "again",
                      class_name(instance)));
    if (stores) instance.attr("restore")(json.attr("loads")(text));
  });
}

}  // namespace faba::python
