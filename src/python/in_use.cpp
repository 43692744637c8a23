#include "python/in_use.h"

#include <unistd.h>

#include "core/error.h"

namespace faba::python {

Exclusive::Exclusive(std::string name) : name_(std::move(name)), process_(getpid()) {}

InUse::InUse(Exclusive& object) : object_(object) {
  if (object.threads > 1 && getpid() != object.process_)
    throw Error(
        Errc::usage, object.name_,
        "was created before this process was forked, and its threads exist only in the other process; "
        "create it in this process, or with threads=1");
  if (object.used_.exchange(true))
    throw Error(
        Errc::usage, object.name_,
        "is used by another thread, or by a part of its own control loop; wait for that call, or create "
        "an object for each thread");
}

InUse::~InUse() { object_.used_ = false; }

}  // namespace faba::python
