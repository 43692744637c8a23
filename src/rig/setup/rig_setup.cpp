#include "rig/setup/rig_setup.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/counted.h"
#include "rig/setup/guard_message.h"

namespace faba {
namespace {

// A simulated device without `at`.
template <class Part>
bool lacks_bench(const Part& p) {
  return p.has(Trait::simulated) && p.resolved.value("at", "").empty();
}

// Coil k of the field wired to output k of a simulated bench.
std::vector<WiredCoil> default_wiring(std::size_t coils, const Amplifier::Params& a) {
  std::vector<WiredCoil> all(coils);
  for (std::size_t k = 0; k < coils; ++k) {
    WiredCoil& c = all[k];
    c.channel = c.sense = std::to_string(k);
    c.gain = c.sense_gain = a.gain;
    c.neutral = c.sense_neutral = a.reference;
    c.least_volts = a.least_volts;
    c.most_volts = a.most_volts;
    c.max_current = c.max_rms = a.saturation;
  }
  return all;
}

std::vector<WiredCoil> read_coils(const Node& list, std::size_t coils) {
  if (!list.json->is_array())
    list.fail("must be a list of tables [[rig.coil]], one for each coil of the field");
  if (list.json->size() != coils)
    list.fail(fmt::format("has {}, but the field has {}; give one [[rig.coil]] for each coil",
                          counted(list.json->size(), "table"), counted(coils, "coil")));
  std::vector<WiredCoil> all;
  for (std::size_t k = 0; k < coils; ++k) {
    const Node n = list.item(k);
    const WiredCoil c = WiredCoil::schema().parse(n);
    if (c.channel.empty()) n.fail("needs channel = \"...\", an output of the driver");
    for (const WiredCoil& other : all)
      if (other.channel == c.channel && (other.volts(0) != c.volts(0) || other.least_volts != c.least_volts ||
                                         other.most_volts != c.most_volts))
        n.fail(fmt::format(
            "coils of the same channel \"{}\" must have the same voltage of zero current and output range",
            c.channel));
    all.push_back(c);
  }
  return all;
}

}  // namespace

Schema<BenchParams> BenchParams::schema() {
  return Schema<BenchParams>("bench", "Electronics and simulated faults of a simulated bench")
      .include(&BenchParams::amplifier, Amplifier::schema())
      .add("freeze_after", &BenchParams::freeze_after,
           {.unit = "s", .min = 0, .max = 1e6, .doc = "Time at which the camera hangs; default: never"})
      .add("corrupt_one_of", &BenchParams::corrupt_one_of,
           {.min = 0, .max = 1e6, .doc = "One of this number of frames arrives damaged; 0: none"});
}

Schema<StepResponseParams> StepResponseParams::schema() {
  using P = StepResponseParams;
  return Schema<P>("step_response", "Recording of step responses")
      .add("direction", &P::direction,
           {.unit = "deg",
            .min = -360,
            .max = 360,
            .doc = "Swimming direction before the field reversal: 0 right, 90 down in the image"})
      .add("field", &P::field, {.unit = "T", .min = 0, .max = 0.1, .doc = "Field strength"})
      .add("gather", &P::gather,
           {.unit = "s", .min = 0.1, .max = 1e5, .doc = "Time in the initial direction without recording"})
      .add("before", &P::before,
           {.unit = "s", .min = 0, .max = 1e4, .doc = "Recorded time before the field reversal"})
      .add("record", &P::record,
           {.unit = "s",
            .min = 0.1,
            .max = 1e5,
            .doc = "Recorded time after the field reversal",
            .source = "thesis 3.4.1: 6 s"})
      .add("repeat", &P::repeat, {.min = 1, .max = 1e5, .doc = "Number of step responses"})
      .add("every", &P::every,
           {.unit = "s",
            .min = 0,
            .max = 1e6,
            .doc = "Interval between the starts of consecutive recordings; no pause if a recording takes "
                   "longer"});
}

Schema<RigSetup::Params> RigSetup::Params::schema() {
  return Schema<Params>("rig", "The bench: camera, coil driver, wiring and guard")
      .add("camera_timeout", &Params::camera_timeout,
           {.unit = "s",
            .min = 0.1,
            .max = 1e4,
            .doc = "Timeout after which a run without frames ends; the coils are de-energised much earlier"})
      .add("delay", &Params::delay,
           {.unit = "s",
            .min = 0,
            .max = 10,
            .doc =
                "Delay from mid-exposure of a frame to its command, for controllers that compensate for it; "
                "default: measured before a run"});
}

RigSetup RigSetup::read(const Node& n, std::size_t coils, const CameraRegistry& cameras,
                        const CoilDriverRegistry& drivers) {
  RigSetup s;
  s.params = Params::schema().parse(n, {"camera", "driver", "coil", "guard", "bench", "step_response"});
  const Json simulated = "simulated";
  s.camera = n.has("camera") ? cameras.resolve(n.child("camera"))
                             : cameras.resolve(Node(simulated, "rig.camera", n.document));
  s.driver = n.has("driver") ? drivers.resolve(n.child("driver"))
                             : drivers.resolve(Node(simulated, "rig.driver", n.document));
  if (n.has("guard")) s.guard = CoilGuard::schema().parse(n.child("guard"));
  if (n.has("step_response")) s.step_response = StepResponseParams::schema().parse(n.child("step_response"));
  if (n.has("bench")) s.bench = BenchParams::schema().parse(n.child("bench"));
  if (coils > kMostCoils)
    n.fail(fmt::format("a bench has at most {} coils, but the field has {}", kMostCoils, coils));
  if (n.has("coil"))
    s.coils = read_coils(n.child("coil"), coils);
  else if (s.driver.has(Trait::simulated) || s.driver.has(Trait::no_current))
    s.coils = default_wiring(coils, s.bench.amplifier);
  else
    n.fail("needs a table [[rig.coil]] for each coil of the field, with channel and gain");
  return s;
}

Json RigSetup::resolved() const {
  Json j = Params::schema().to_json(params);
  j["camera"] = camera.resolved;
  j["driver"] = driver.resolved;
  j["guard"] = CoilGuard::schema().to_json(guard);
  j["step_response"] = StepResponseParams::schema().to_json(step_response);
  if (camera.has(Trait::simulated) || driver.has(Trait::simulated))
    j["bench"] = BenchParams::schema().to_json(bench);
  j["coil"] = Json::array();
  for (const WiredCoil& c : coils) j["coil"].push_back(WiredCoil::schema().to_json(c));
  return j;
}

Json RigSetup::json_schema() {
  Json j = Params::schema().json_schema();
  j["properties"]["guard"] = CoilGuard::schema().json_schema();
  j["properties"]["step_response"] = StepResponseParams::schema().json_schema();
  j["properties"]["bench"] = BenchParams::schema().json_schema();
  j["properties"]["coil"] = {{"type", "array"},
                             {"description", "Wiring and calibration of each coil"},
                             {"items", WiredCoil::schema().json_schema()}};
  return j;
}

GuardSetup RigSetup::guard_setup(double frame_period, const std::filesystem::path& log) const {
  return {driver, coils, guard, frame_period, log};
}

std::vector<double> RigSetup::max_current() const {
  std::vector<double> most;
  for (const WiredCoil& c : coils) most.push_back(std::min(c.max_current, c.reach()));
  return most;
}

bool RigSetup::needs_bench() const { return lacks_bench(camera) || lacks_bench(driver); }

RigSetup RigSetup::at(const std::string& socket, const CameraRegistry& cameras,
                      const CoilDriverRegistry& drivers) const {
  RigSetup s = *this;
  Document d;
  d.root = {{"camera", camera.resolved}, {"driver", driver.resolved}};
  if (lacks_bench(camera)) d.root["camera"]["at"] = socket;
  if (lacks_bench(driver)) d.root["driver"]["at"] = socket;
  s.camera = cameras.resolve(Node(d).child("camera"));
  s.driver = drivers.resolve(Node(d).child("driver"));
  return s;
}

}  // namespace faba
