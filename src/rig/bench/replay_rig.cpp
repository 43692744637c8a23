#include "rig/bench/replay_rig.h"

#include <fmt/format.h>

#include <bit>

#include "core/table.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {

ReplayRig::ReplayRig(const std::filesystem::path& video, const std::filesystem::path& commands)
    : video_(video) {
  const Table table = read_table(commands, LastLine::drop);
  const auto t = table.column("t_s"), age = table.column("age_s"),
             coils_off = table.column(
                 table.has("rested") ? "rested" : "coils_off");  // column name of the previous version
  std::vector<std::span<const double>> current;
  for (std::size_t k = 0;; ++k) {
    const auto one = table.find(fmt::format("current_{}_a", k));
    if (one.empty()) break;
    current.push_back(one);
  }
  const auto frame = table.column("frame");
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (frame[i] != double(i))
      throw Error(Errc::input, commands.string(),
                  fmt::format("row {} has frame {:g}; rows must have frames 0, 1, 2 ...: the file was "
                              "modified after recording",
                              i + 1, frame[i]));
    Row& row = rows_.emplace_back(Row{t[i], age[i], coils_off[i] != 0, {}});
    for (const auto& coil : current) row.current.push_back(coil[i]);
  }
}

bool ReplayRig::read(Observation& out) {
  double video_t = 0;
  if (next_ >= rows_.size() || !video_.read(grey_, video_t)) return false;
  const Row& row = rows_[next_];
  out.frame = next_++;
  out.t = row.t;
  out.age = row.age;
  out.coils_off = row.coils_off;
  out.seen.clear();
  out.image = std::make_shared<Gray8>(rounded(grey_));
  return true;
}

bool ReplayRig::more() {
  double t = 0;
  return video_.read(grey_, t);
}

void ReplayRig::write(const Command& c) {
  const std::vector<double>& then = rows_[next_ - 1].current;
  bool same = then.size() == c.current.size();
  for (std::size_t k = 0; same && k < then.size(); ++k)
    same = std::bit_cast<std::uint64_t>(then[k]) == std::bit_cast<std::uint64_t>(c.current[k]);
  equal_ += same;
  if (!same && !first_other_) first_other_ = next_ - 1;
}

}  // namespace faba
