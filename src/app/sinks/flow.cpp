#include <fmt/format.h>

#include "app/sinks/sinks.h"
#include "vision/flow/flow_file.h"

namespace faba {
namespace {

/// Optical flow computed from the rendered pictures, so that video compression has no effect.
class FlowSink final : public RunSink {
 public:
  FlowSink(const SinkContext& c, Archive* resume)
      : c_(c), path_(c.dir / "flow.h5"), method_(c.flow.make({c.pool})) {
    std::uint64_t keep = 0;
    if (resume) *resume& keep& before_.px& t_before_;
    const FlowInfo info{c.frame.width, c.frame.height,         c.frame_rate,
                        c.um_per_px,   c.flow.resolved.dump(), "rendered frames of the run"};
    before_.width = info.width;
    before_.height = info.height;
    writer_.emplace(keep ? path_.string() + ".new" : path_.string(), info);
    if (keep) import_flows(keep);
  }

  void take(const Tick& t) override {
    const ImageRef picture = c_.frames->picture(t);
    after_.width = picture->width;
    after_.height = picture->height;
    after_.px.assign(picture->px.begin(), picture->px.end());
    const double now = c_.frames->time_of(t);
    if (!before_.px.empty()) {
      method_->between(before_, after_, flow_);
      writer_->write(t.index - 1, t_before_, now, flow_);
    }
    std::swap(before_, after_);
    t_before_ = now;
  }

  void checkpoint(Archive& a) override {
    writer_->sync();
    std::uint64_t rows = writer_->size();
    a& rows& before_.px& t_before_;
  }
  void finish(bool) override { writer_->close(); }

 private:
  // HDF5 cannot append to a file whose writer was killed, but can read it.
  void import_flows(std::uint64_t keep) {
    {
      const FlowFileReader old(path_);
      if (old.size() < keep)
        throw Error(Errc::input, path_.string(),
                    fmt::format("has {} flows, but the checkpoint has {}", old.size(), keep));
      std::uint64_t frame = 0;
      double t0 = 0, t1 = 0;
      for (std::uint64_t k = 0; k < keep; ++k) {
        old.read(k, frame, t0, t1, flow_);
        writer_->write(frame, t0, t1, flow_);
      }
    }
    writer_->rename_complete(path_);
  }

  SinkContext c_;
  std::filesystem::path path_;
  std::unique_ptr<FlowMethod> method_;
  std::optional<FlowFileWriter> writer_;
  GrayF before_, after_;
  double t_before_ = 0;
  Flow flow_;
};

}  // namespace

std::unique_ptr<RunSink> flow_sink(const SinkContext& c, Archive* resume) {
  return std::make_unique<FlowSink>(c, resume);
}

}  // namespace faba
