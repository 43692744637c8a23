#include "app/scenario/scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/hash.h"
#include "field/library.h"

namespace faba {

Schema<Scenario::Params> Scenario::schema() {
  return Schema<Params>("scenario", "A swarm, its coils, its controller and what is recorded")
      .add("title", &Params::title, {.doc = "What the run is called in reports"})
      .add("seed", &Params::seed,
           {.min = 0,
            .max = 9007199254740991.0,
            .doc = "Same scenario and seed, same bits; drawn and printed when absent"})
      .add("duration", &Params::duration, {.unit = "s", .min = 0, .max = 1e6, .doc = "Simulated time"})
      .add("exposure", &Params::exposure,
           {.unit = "s",
            .min = 0,
            .max = 1e6,
            .doc = "Time in air before the run; matters with a motility law"});
}

Schema<Record> Record::schema() {
  return Schema<Record>("record", "What a run keeps beside series.csv, manifest and report")
      .add("tracks", &Record::tracks, {.doc = "tracks.h5: positions of all cells"})
      .add("tracks_every", &Record::tracks_every,
           {.min = 1, .max = 1e6, .doc = "Every how many frames tracks are kept"})
      .add("compress", &Record::compress,
           {.doc = "Compress tracks.h5 (lossless; a quarter smaller, ten times slower)"})
      .add("video", &Record::video, {.doc = "video.mp4: the swarm, for browsers"})
      .add("video_every", &Record::video_every,
           {.min = 1, .max = 1e6, .doc = "Every how many frames a picture is rendered"})
      .add("lossless", &Record::lossless, {.doc = "video.avi as well, exact to the grey level, for Fiji"})
      .add("as_seen", &Record::as_seen,
           {.doc = "Videos show what the camera sees through the microscope of [microscope], not a drawing"})
      .add("flow", &Record::flow,
           {.doc = "flow.h5: optical flow between the frames that the camera sees, made with [flow]"})
      .add("checkpoint", &Record::checkpoint,
           {.unit = "s",
            .min = 0.1,
            .max = 1e6,
            .doc = "Time on the clock between checkpoints: what a crash can cost"});
}

Schema<CameraParams> CameraParams::schema() {
  return Schema<CameraParams>("camera", "When the camera looks, and what it tells")
      .add("rate", &CameraParams::rate,
           {.unit = "Hz",
            .min = 0.01,
            .max = 1e5,
            .doc = "Frames per second",
            .source = "thesis: 90 frames in 6 s (A0)"})
      .add("delay_frames", &CameraParams::delay_frames,
           {.min = 0, .max = 1000, .doc = "Age of a picture, in frames, when the controller gets it"})
      .add("jitter", &CameraParams::jitter,
           {.unit = "s",
            .min = 0,
            .max = 1e3,
            .doc = "Sd of the frames' times about the regular ones, at most 0.4 frames to either side"})
      .add("sensor", &CameraParams::sensor,
           {.doc = "positions: the loop is told where every cell is; frames: it gets pictures as the "
                   "[microscope] renders them, and has to find the cells itself",
            .choices = {"positions", "frames"}});
}

Schema<ScaleParams> ScaleParams::schema() {
  return Schema<ScaleParams>("scale", "How pixels, iterations and field units hang together with SI")
      .add("um_per_px", &ScaleParams::um_per_px,
           {.min = 1e-3,
            .max = 1e3,
            .doc = "Micrometres per pixel",
            .source = "thesis's table 4.1 by regression (A20); the thesis itself used 0.8015"})
      .add("iteration", &ScaleParams::iteration,
           {.unit = "s",
            .min = 1e-5,
            .max = 100,
            .doc = "One iteration of the published models; one frame when absent"})
      .add("field_unit", &ScaleParams::field_unit,
           {.unit = "T",
            .min = 1e-9,
            .max = 1,
            .doc = "One field unit of the published models",
            .source = "Earth's field near Rio (B2)"});
}

Schema<LibraryParams> LibraryParams::schema() {
  return Schema<LibraryParams>("library", "A field library, as `faba field library` makes it for the rig")
      .add("file", &LibraryParams::file,
           {.doc = "HDF5 file; beside the scenario, or where the program is called. The field is then taken "
                   "at the "
                   "nodes of its grid"})
      .add(
          "made", &LibraryParams::made,
          {.doc = "What the library is told by; filled in from the file, and refused when it is another one"})
      .check([](const LibraryParams& p) -> std::string {
        return p.file.empty() ? "needs file = \"a library's HDF5 file\"" : "";
      });
}

Schema<SimulationParams> SimulationParams::schema() {
  return Schema<SimulationParams>("simulation", "Numerics")
      .add("step", &SimulationParams::step,
           {.unit = "s",
            .min = 1e-7,
            .max = 10,
            .doc = "Time step, a whole part of a frame; chosen from the models' accuracy when absent"});
}

Schema<Swarm::Params> Swarm::schema() {
  return Schema<Params>("swarm", "One kind of cell among those in the drop")
      .add("count", &Params::count, {.min = 1, .max = 5e7, .doc = "Number of cells"})
      .add("polarity", &Params::polarity,
           {.doc = "north: swims along the field; south: against it",
            .source = "the thesis's cells are south-seeking (A0)",
            .choices = {"north", "south"}})
      .add("responding", &Params::responding,
           {.min = 0, .max = 1, .doc = "Fraction of the cells that feel the field"})
      .add("heading", &Params::heading,
           {.unit = "rad",
            .min = -1000,
            .max = 1000,
            .doc = "Where cells that feel the field head at first, as those that a field has held: 0 deg "
                   "right, 90 "
                   "deg up; any way when absent. basic and adapted have no heading"});
}

std::uint64_t Scenario::frames() const {
  return std::uint64_t(std::max(1.0, std::floor(params.duration * camera.rate + 0.5)));
}

Scale Scenario::si_scale() const {
  return {scale.um_per_px / 1e6, scale.iteration.value_or(frame_period()), scale.field_unit};
}

int Scenario::polarity() const {
  double sum = 0;
  for (const Swarm& s : swarms)
    sum += (s.params.polarity == Swarm::Polarity::north ? 1.0 : -1.0) * double(s.params.count);
  return sum > 0 ? 1 : -1;
}

Json Scenario::resolved() const {
  Json j = schema().to_json(params);
  j["scale"] = ScaleParams::schema().to_json(scale);
  j["camera"] = CameraParams::schema().to_json(camera);
  if (renders()) j["microscope"] = MicroscopeParams::schema().to_json(microscope);
  j["simulation"] = SimulationParams::schema().to_json(simulation);
  j["arena"] = arena.resolved;
  j["exclusion"] = Exclusion::schema().to_json(exclusion);
  j["field"] = field.resolved;
  j["motility"] = motility.resolved;
  j["swarm"] = Json::array();
  for (const Swarm& s : swarms) {
    Json one = Swarm::schema().to_json(s.params);
    one["model"] = s.model.resolved;
    one["start"] = s.start.resolved;
    j["swarm"].push_back(one);
  }
  j["estimator"] = estimator.resolved;
  j["reference"] = reference.resolved;
  j["controller"] = controller.resolved;
  j["limits"] = Limits::schema().to_json(limits);
  if (record.flow) j["flow"] = flow.resolved;
  j["record"] = Record::schema().to_json(record);
  if (library) j["library"] = LibraryParams::schema().to_json(*library);
  if (rig) j["rig"] = rig->resolved();
  if (!events.empty()) j["event"] = Json::array();
  for (const Event& e : events) j["event"].push_back(e.resolved());
  return j;
}

std::string Scenario::hash() const {
  Json j = resolved();
  for (const char* key : {"title", "seed", "record", "flow", "rig"}) j.erase(key);
  if (camera.sensor == CameraParams::Sensor::positions) j.erase("microscope");  // of the recording only
  if (library) j["library"].erase("file");  // `made` says what is in it, wherever it lies
  Hash h;
  h.text(j.dump());
  return h.hex();
}

}  // namespace faba
