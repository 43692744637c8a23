#include "server/bench/arming_permits.h"

#include <utility>

#include "core/error.h"
#include "server/access.h"

namespace faba {

void ArmingPermits::steering(std::uint64_t page) {
  const std::lock_guard lock(mutex_);
  steering_ = page;
  if (permit_ && permit_->page != page) permit_.reset();
}

std::string ArmingPermits::issue(std::uint64_t page, const std::string& purpose, double now) {
  const std::lock_guard lock(mutex_);
  permit_.reset();
  if (page == 0 || page != steering_)
    throw Error(Errc::usage, "permit", "another page is steering; take control first");
  permit_ = {random_token(), purpose, page, now};
  return permit_->secret;
}

void ArmingPermits::use(const std::string& permit, std::uint64_t page, const std::string& purpose,
                        double now) {
  const std::lock_guard lock(mutex_);
  const std::optional<Permit> present = std::exchange(permit_, std::nullopt);
  const bool valid = present && page != 0 && page == steering_ && page == present->page &&
                     purpose == present->purpose && now - present->issued <= kValid &&
                     equal_in_constant_time(permit, present->secret);
  if (!valid)
    throw Error(
        Errc::usage, "permit",
        "the permission to arm the coils is not valid: it is used up, too old, or was given to another "
        "page; arm again");
}

void ArmingPermits::revoke() {
  const std::lock_guard lock(mutex_);
  permit_.reset();
}

}  // namespace faba
