#include "cli/options/scene.h"

#include "app/files/from_picture.h"
#include "core/error.h"

namespace faba::cli {

Document read_scene(const SceneOptions& v, std::string* drop_note) {
  Document d = read_toml(v.scene);
  if (!v.from_video.empty()) {
    const std::string note = fit_to_picture(d, v.from_video);
    if (drop_note) *drop_note = note;
  }
  for (const std::string& s : v.set) {
    const auto equals = s.find('=');
    if (equals == std::string::npos || equals == 0)
      throw Error(Errc::usage, "--set " + s,
                  "must have the form PATH=VALUE, such as --set swarm[0].count=200");
    const std::string path = s.substr(0, equals);
    if ((path == "duration" && v.duration) || (path == "seed" && v.seed))
      throw Error(Errc::usage, "--set " + s, "is also given as --" + path + "; give only one of the two");
    d.set(path, s.substr(equals + 1), "--set");
  }
  if (!v.from_video.empty())
    if (const std::string note = take_scale(d, v.from_video); !note.empty() && drop_note)
      *drop_note += "; " + note;
  if (v.duration) d.set("duration", *v.duration, "--duration");
  if (v.seed) d.set("seed", *v.seed, "--seed");
  if (v.as_seen) d.set("record.as_seen", Json(true), "--as-seen");
  if (!d.root.contains("title"))
    d.set("title", Json(std::filesystem::path(v.scene).stem().string()), v.scene);
  return d;
}

void reject_input_in_out(const SceneOptions& v) {
  std::error_code ec;
  for (const std::filesystem::path& input : {std::filesystem::path(v.scene), v.from_video}) {
    if (input.empty() || v.out.empty()) continue;
    const auto folder = std::filesystem::weakly_canonical(input, ec).parent_path();
    if (folder == std::filesystem::weakly_canonical(v.out, ec))
      throw Error(Errc::usage, input.string(),
                  "is in the directory that the run would replace; choose another --out");
  }
}

}  // namespace faba::cli
