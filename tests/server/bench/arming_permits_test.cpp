// Which page may arm the coils, and when.
#include "server/bench/arming_permits.h"

#include <doctest/doctest.h>

#include "core/error.h"

using namespace faba;

namespace {

bool accepted(ArmingPermits& p, const std::string& permit, std::uint64_t page, const std::string& purpose,
              double now) {
  try {
    p.use(permit, page, purpose, now);
    return true;
  } catch (const Error& e) {
    CHECK(e.code() == Errc::usage);
    return false;
  }
}

}  // namespace

TEST_CASE("a permit arms once, for its page, purpose and time") {
  ArmingPermits p;
  p.steering(7);
  const std::string permit = p.issue(7, "run", 100);
  CHECK(permit.size() == 32);
  CHECK(accepted(p, permit, 7, "run", 100 + ArmingPermits::kValid));
  CHECK_FALSE(accepted(p, permit, 7, "run", 100));  // a repeated message
  CHECK_FALSE(accepted(p, p.issue(7, "run", 100), 7, "run", 100.1 + ArmingPermits::kValid));
  CHECK_FALSE(accepted(p, p.issue(7, "run", 100), 7, "jog", 101));
  CHECK_FALSE(accepted(p, p.issue(7, "run", 100), 8, "run", 101));
  CHECK_FALSE(accepted(p, "", 7, "run", 101));
  CHECK_FALSE(accepted(p, permit, 0, "run", 101));
}

TEST_CASE("a wrong attempt uses the permit up") {
  ArmingPermits p;
  p.steering(7);
  const std::string permit = p.issue(7, "run", 0);
  CHECK_FALSE(accepted(p, std::string(32, '0'), 7, "run", 1));
  CHECK_FALSE(accepted(p, permit, 7, "run", 1));
}

TEST_CASE("a newer permit, another steering page and switching off make a permit void") {
  ArmingPermits p;
  p.steering(7);
  const std::string old = p.issue(7, "run", 0);
  const std::string newer = p.issue(7, "run", 1);
  CHECK(old != newer);
  CHECK_FALSE(accepted(p, old, 7, "run", 2));

  const std::string before = p.issue(7, "run", 3);
  p.steering(8);  // page 7 was reloaded or lost its connection
  CHECK_FALSE(accepted(p, before, 7, "run", 4));
  p.steering(7);
  CHECK_FALSE(accepted(p, before, 7, "run", 4));

  const std::string off = p.issue(7, "run", 5);
  p.revoke();
  CHECK_FALSE(accepted(p, off, 7, "run", 6));
}

TEST_CASE("only the page that steers gets a permit") {
  ArmingPermits p;
  CHECK_THROWS_AS((void)p.issue(0, "run", 0), Error);
  CHECK_THROWS_AS((void)p.issue(1, "run", 0), Error);
  p.steering(2);
  CHECK_THROWS_AS((void)p.issue(1, "run", 0), Error);
  CHECK_NOTHROW((void)p.issue(2, "run", 0));
}
