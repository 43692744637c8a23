#include "control/trap.h"

#include <cmath>

#include "field/library.h"
#include "field/null.h"

namespace faba {

Schema<Trap::Params> Trap::Params::schema() {
  return Schema<Params>("trap", "Currents for a zero of the field")
      .add("source", &Params::source,
           {.doc = "solve: currents computed for the setpoint; library: entry of [library] with the nearest "
                   "zero, as in the thesis (A7)",
            .choices = {"solve", "library"}})
      .add("earth", &Params::earth,
           {.doc = "Compensate the Earth's field; must be true with source = \"library\", which always "
                   "compensates it"})
      .check([](const Params& p) -> std::string {
        return p.source == Source::library && !p.earth ? "earth = false is not possible with source = "
                                                         "\"library\", which compensates the Earth's field"
                                                       : "";
      });
}

Trap::Trap(const Params& p, const ControlContext& c) : p_(p), c_(c), current_(c.field->coils(), 0.0) {
  if (p.source == Source::library && !c.library)
    throw Error(Errc::usage, "controller.source",
                "\"library\" needs a library file; set [library] file = \"library.h5\"");
}

Command Trap::at(Vec2 at) {
  if ((current_valid_ && at == at_) || !std::isfinite(norm(at))) return {current_};
  if (p_.source == Source::library) {
    if (const auto entry = c_.library->nearest(at, c_.polarity))
      current_ = c_.library->entries()[*entry].current;
  } else {
    const FieldNull n = null_at(*c_.field, at, c_.polarity, c_.max_current, p_.earth);
    if (n.reachable) current_ = n.current;
  }
  current_valid_ = true;
  at_ = at;
  return {current_};
}

}  // namespace faba
