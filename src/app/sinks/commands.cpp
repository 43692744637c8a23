#include <fmt/format.h>

#include "app/sinks/run_files.h"
#include "app/sinks/sinks.h"
#include "core/file.h"

namespace faba {
namespace {

/// Inputs of the control decisions other than pictures, and the commands, with full precision.
class Commands final : public RunSink {
 public:
  explicit Commands(const SinkContext& c) : file_(c.dir / run_files::kCommands) {
    std::string head = "frame,camera_frame,t_s,age_s,coils_off";
    for (std::size_t k = 0; k < c.field->coils(); ++k) head += fmt::format(",current_{}_a", k);
    file_.append(head + '\n');
  }
  void take(const Tick& t) override {
    file_.append(fmt::format("{},{},{},{},{:d},{}\n", t.index, t.seen.frame, t.seen.t, t.seen.age,
                             t.seen.coils_off, fmt::join(t.command.current, ",")));
  }
  void checkpoint(Archive&) override { file_.sync(); }  // a run on a bench is not resumed
  void finish(bool) override {
    file_.sync();
    file_.close();
  }

 private:
  OutputFile file_;
};

}  // namespace

std::unique_ptr<RunSink> commands_sink(const SinkContext& c) { return std::make_unique<Commands>(c); }

}  // namespace faba
