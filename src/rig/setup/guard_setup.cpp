#include "rig/setup/guard_setup.h"

namespace faba {

std::vector<CoilGuard::Bounds> GuardSetup::bounds() const {
  std::vector<CoilGuard::Bounds> b;
  for (const WiredCoil& c : coils) b.push_back({c.max_current, c.max_rms});
  return b;
}

DriverContext GuardSetup::context() const {
  const CoilWiring wiring(coils);
  DriverContext c{wiring.channels(), wiring.senses(), {}, {}, wiring.neutral()};
  for (const std::string& channel : c.channels)
    for (const WiredCoil& coil : coils)
      if (coil.channel == channel) {
        c.least_volts.push_back(coil.least_volts);
        c.most_volts.push_back(coil.most_volts);
        break;
      }
  return c;
}

Json GuardSetup::to_json() const {
  Json wired = Json::array();
  for (const WiredCoil& c : coils) wired.push_back(WiredCoil::schema().to_json(c));
  return {{"version", FABA_VERSION},
          {"driver", driver.resolved},
          {"coil", wired},
          {"guard", CoilGuard::schema().to_json(guard)},
          {"frame_period", frame_period},
          {"log", log.string()}};
}

GuardSetup GuardSetup::read(const Json& j, const CoilDriverRegistry& drivers) {
  Document d;
  d.root = j;
  const Node root(d);
  if (j.value("version", "") != FABA_VERSION)
    root.fail("comes from another version of Faba; reinstall faba-coil-guard");
  GuardSetup s;
  s.driver = drivers.resolve(root.child("driver"));
  for (std::size_t i = 0; i < j.at("coil").size(); ++i)
    s.coils.push_back(WiredCoil::schema().parse(root.child("coil").item(i)));
  s.guard = CoilGuard::schema().parse(root.child("guard"));
  s.frame_period = j.at("frame_period").get<double>();
  s.log = j.at("log").get<std::string>();
  return s;
}

}  // namespace faba
