#include "control/trap.h"

#include <cmath>

#include "field/library.h"
#include "field/null.h"

namespace faba {

Schema<Trap::Params> Trap::Params::schema() {
  return Schema<Params>("trap", "Where the currents for a zero of the field come from")
      .add("source", &Params::source,
           {.doc = "solve: computed for the very place; library: the entry of [library] whose zero is "
                   "nearest, as in "
                   "the thesis (A7)",
            .choices = {"solve", "library"}})
      .add(
          "earth", &Params::earth,
          {.doc = "Allow for the Earth's field; false: as on a rig where nobody does. A library always does"})
      .check([](const Params& p) -> std::string {
        return p.source == Source::library && !p.earth
                   ? "a library allows for the Earth's field: leave out earth = false"
                   : "";
      });
}

Trap::Trap(const Params& p, const ControlContext& c) : p_(p), c_(c), current_(c.field->coils(), 0.0) {
  if (p.source == Source::library && !c.library)
    throw Error(Errc::usage, "controller.source",
                "there is no library to take currents from; name its file: [library] file = \"library.h5\"");
}

Command Trap::at(Vec2 at) {
  if ((known_ && at == at_) || !std::isfinite(norm(at))) return {current_};
  if (p_.source == Source::library) {
    if (const auto entry = c_.library->nearest(at, c_.polarity))
      current_ = c_.library->entries()[*entry].current;
  } else {
    const FieldNull n = null_at(*c_.field, at, c_.polarity, c_.max_current, p_.earth);
    if (n.reachable) current_ = n.current;
  }
  known_ = true;
  at_ = at;
  return {current_};
}

}  // namespace faba
