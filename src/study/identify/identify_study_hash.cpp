#include <fmt/format.h>

#include <fstream>
#include <set>

#include "core/error.h"
#include "core/hash.h"
#include "study/data/run_video.h"
#include "study/identify/identify_study.h"

namespace faba {
namespace {

// Hashes the content of a video, not its path: a different video under the same name is a different study.
void hash_content(const std::filesystem::path& file, Hash& h) {
  namespace fs = std::filesystem;
  if (fs::is_directory(file)) {
    std::set<fs::path> inside;  // sorted
    for (const auto& e : fs::directory_iterator(file)) inside.insert(e.path());
    for (const fs::path& p : inside) {
      const std::string name = p.filename().string();
      const bool counts = !is_run(file) || name.starts_with("video.") || name == "series.csv";
      if (fs::is_regular_file(p) && counts) {
        h.text(name);
        hash_content(p, h);
      }
    }
    return;
  }
  std::ifstream in(file, std::ios::binary);
  std::vector<char> block(1u << 20);
  while (in) {
    in.read(block.data(), std::streamsize(block.size()));
    h.text({block.data(), std::size_t(in.gcount())});
  }
}

void hash_input(const ResponseInput& v, Hash& h) {
  h.text(v.digest);
  h.text(v.experiment);
  for (const double x : {v.exposure_s, v.part.fps, v.um_per_px.value_or(0), v.reversal_s.value_or(-1),
                         v.direction_deg.value_or(-999), v.duration_s.value_or(-1)})
    h.value(x);
  if (v.part.from_s > 0 || v.part.to_s)
    for (const double x : {v.part.from_s, v.part.to_s.value_or(-1)}) h.value(x);
  for (const FieldSegment& d : v.segments) {
    h.value(d.t0_s);
    h.value(d.t1_s);
    h.value(d.direction_deg);
  }
}

}  // namespace

void digest_videos(IdentifyStudy& study) {
  for (ResponseInput& v : study.videos) {
    Hash h;
    hash_content(v.file, h);
    v.digest = h.hex();
  }
}

void take_digests(IdentifyStudy& study, const std::vector<std::string>& digests) {
  if (digests.size() != study.videos.size())
    throw Error(
        Errc::usage, study.title,
        fmt::format("has {} videos, but the study was planned with {}", study.videos.size(), digests.size()));
  for (std::size_t v = 0; v < study.videos.size(); ++v) study.videos[v].digest = digests[v];
}

std::string measurement_key(const IdentifyStudy& study, std::size_t video) {
  const ResponseInput& v = study.videos[video];
  Hash h;
  h.text(FABA_VERSION);
  h.value(int(study.boundary));
  h.value(int(study.measure));
  hash_input(v, h);
  // Episodes without the name of an experiment have that of the file.
  h.text(v.file.filename().string());
  return h.hex();
}

std::string study_hash(const IdentifyStudy& study) {
  Hash h;
  h.text("identify");
  h.value(study.seed);
  h.value(int(study.boundary));
  h.value(int(study.look));
  h.value(int(study.measure));
  h.value(study.simulations);
  h.value(study.timing_s.value_or(-1));
  for (const double x : {study.scale_sd, study.field_sd, study.count_sd})
    if (x > 0) h.value(x);
  h.text(study.scene.dump());
  for (const ResponseInput& v : study.videos) hash_input(v, h);
  for (const Candidate& c : study.candidates) {
    h.text(c.model.name);
    h.text(c.model.part.dump());
    h.value(c.field_strength_t.value_or(-1));
    for (const double v : c.legacy_values) h.value(v);
    if (c.model.extra.contains(kPopulations)) h.value(c.model.extra[kPopulations].get<int>());
    for (const auto& [path, value] : c.model.set) {
      h.text(path);
      h.text(value.dump());
    }
    for (const FreeParameter& p : c.free) {
      h.text(p.path);
      for (const double x : {p.low, p.high, p.stretch, p.normal_prior ? p.normal_prior->mean : 0,
                             p.normal_prior ? p.normal_prior->sd : 0})
        h.value(x);
    }
  }
  return h.hex();
}

std::string design_hash(const IdentifyStudy& study) {
  IdentifyStudy design = study;
  design.seed = 0;
  for (Candidate& c : design.candidates) c.legacy_values.clear();
  return study_hash(design);
}

}  // namespace faba
