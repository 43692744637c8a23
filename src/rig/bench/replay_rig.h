#pragma once
#include <filesystem>
#include <optional>

#include "rig/rig.h"
#include "vision/files/video_reader.h"

namespace faba {

/// A recorded run in place of a bench: its images with the recorded times, ages and "coils off" flags.
/// Commands are not executed but compared with the recorded ones.
class ReplayRig final : public Rig {
 public:
  /// `video` must be lossless; `commands`: the commands.csv of the run. Throws Error(input).
  ReplayRig(const std::filesystem::path& video, const std::filesystem::path& commands);

  bool read(Observation& out) override;
  bool more();  ///< the video has more frames than the run has commands
  void write(const Command& c) override;
  void safe() noexcept override {}

  std::uint64_t frames() const { return rows_.size(); }
  std::uint64_t equal() const {
    return equal_;
  }  ///< commands so far that are bitwise equal to the recorded ones
  /// The first frame whose command differs.
  const std::optional<std::uint64_t>& first_difference() const { return first_other_; }

 private:
  struct Row {
    double t, age;
    bool coils_off;
    std::vector<double> current;
  };
  VideoReader video_;
  GrayF grey_;
  std::vector<Row> rows_;
  std::uint64_t next_ = 0, equal_ = 0;
  std::optional<std::uint64_t> first_other_;
};

}  // namespace faba
