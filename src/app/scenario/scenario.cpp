#include "app/scenario/scenario.h"

#include <algorithm>
#include <cmath>

#include "app/scenario/section.h"
#include "core/hash.h"

namespace faba {

Schema<Scenario::Params> Scenario::schema() {
  return Schema<Params>("scenario", "A swarm, its coils, its controller and the recording")
      .add("title", &Params::title, {.doc = "Title of the run in reports"})
      .add("seed", &Params::seed,
           {.min = 0,
            .max = 9007199254740991.0,
            .doc = "Seed of all random numbers: the same scenario and seed give a bit-identical run; "
                   "default: a random seed, which is printed"})
      .add("duration", &Params::duration, {.unit = "s", .min = 0, .max = 1e6, .doc = "Simulated time"})
      .add("exposure", &Params::exposure,
           {.unit = "s",
            .min = 0,
            .max = 1e6,
            .doc = "Air exposure time before the run; has an effect with a motility law",
            .title = "Air exposure time"});
}

std::uint64_t Scenario::frames() const {
  return std::uint64_t(std::max(1.0, std::floor(params.duration * camera.rate + 0.5)));
}

FrameRange Scenario::recorded_frames() const {
  constexpr double kRounding = 1e-6;  // frames; a time such as 0.3 s at 30 Hz is that of a frame
  const auto first_at = [&](double t) { return std::uint64_t(std::ceil(t * camera.rate - kRounding)); };
  const std::uint64_t first = std::min(first_at(record.from), frames());
  return {first, std::clamp(record.to ? first_at(*record.to) : frames(), first, frames())};
}

Scale Scenario::si_scale() const {
  return {scale.used_um_per_px() / 1e6, scale.iteration.value_or(frame_period()), scale.field_unit};
}

int Scenario::polarity() const {
  double sum = 0;
  for (const Swarm& s : swarms)
    sum += (s.params.polarity == Swarm::Polarity::north ? 1.0 : -1.0) * double(s.params.count);
  return sum > 0 ? 1 : -1;
}

Json Scenario::default_estimator() const {
  if (!sees_pictures()) return "mean";
  return steers() ? "image" : "none";
}

Json Scenario::default_reference() const { return steers() ? "hold" : "none"; }

std::shared_ptr<const VideoBackground> Scenario::ground() const {
  if (microscope.background.empty()) return nullptr;
  if (!readers.ground)
    throw Error(Errc::usage, "microscope.background", "this build of the program cannot read videos");
  try {
    return std::make_shared<const VideoBackground>(readers.ground(microscope.background));
  } catch (const Error& e) {  // names the key
    throw Error(e.code(), "microscope.background", e.what());
  }
}

std::shared_ptr<const FieldLibrary> Scenario::field_library() const {
  // read_library() has checked that the reader exists.
  return library ? readers.library(library->file) : nullptr;
}

const std::vector<Section>& scenario_sections() {
  static const Sections sections = [] {
    Sections s;
    Scenario::describe(s);
    return s;
  }();
  return sections.all();
}

Json Scenario::resolved() const {
  Json j = schema().to_json(params);
  for (const Section& section : scenario_sections())
    if (Json value = section.resolved(*this); !value.is_null()) j[section.key] = std::move(value);
  return j;
}

std::string Scenario::hash() const {
  Json j = schema().to_json(params);
  for (const char* key : {"title", "seed"}) j.erase(key);
  for (const Section& section : scenario_sections())
    if (Json value = section.hashed(*this); !value.is_null()) j[section.key] = std::move(value);
  Hash h;
  h.text(j.dump());
  return h.hex();
}

}  // namespace faba
