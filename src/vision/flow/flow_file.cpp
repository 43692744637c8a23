#include "vision/flow/flow_file.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/file.h"
#include "core/h5/h5.h"

namespace faba {
namespace {

static_assert(std::endian::native == std::endian::little);
constexpr float kFloTag = 202021.25F, kUnknown = 1e10F, kLargestKnown = 1e9F;
constexpr std::int32_t kLargestSide = 1 << 16;
constexpr const char* kFormat = "faba flow 1";

}  // namespace

void write_flo(const std::filesystem::path& path, const Flow& flow) {
  const std::int32_t size[2] = {flow.width(), flow.height()};
  std::string bytes(12 + 8 * flow.u.px.size(), '\0');
  std::memcpy(&bytes[0], &kFloTag, 4);
  std::memcpy(&bytes[4], size, 8);
  for (std::size_t i = 0; i < flow.u.px.size(); ++i) {
    const bool known = std::isfinite(flow.u.px[i]) && std::isfinite(flow.v.px[i]);
    const float uv[2] = {known ? flow.u.px[i] : kUnknown, known ? flow.v.px[i] : kUnknown};
    std::memcpy(&bytes[12 + 8 * i], uv, 8);
  }
  write_file(path, bytes);
}

Flow read_flo(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  float tag = 0;
  std::int32_t size[2] = {0, 0};
  if (bytes.size() >= 12) {
    std::memcpy(&tag, bytes.data(), 4);
    std::memcpy(size, bytes.data() + 4, 8);
  }
  if (tag != kFloTag || size[0] < 1 || size[1] < 1 || size[0] > kLargestSide || size[1] > kLargestSide)
    throw Error(Errc::input, path.string(), "is not a flow in the Middlebury format (.flo)");
  Flow flow{GrayF(size[0], size[1]), GrayF(size[0], size[1])};
  if (bytes.size() != 12 + 8 * flow.u.px.size())
    throw Error(Errc::input, path.string(),
                fmt::format("has {} bytes; a flow of {} x {} px must have {}", bytes.size(), size[0], size[1],
                            12 + 8 * flow.u.px.size()));
  for (std::size_t i = 0; i < flow.u.px.size(); ++i) {
    float uv[2];
    std::memcpy(uv, bytes.data() + 12 + 8 * i, 8);
    const bool known = std::fabs(uv[0]) <= kLargestKnown && std::fabs(uv[1]) <= kLargestKnown;
    flow.u.px[i] = known ? uv[0] : std::numeric_limits<float>::quiet_NaN();
    flow.v.px[i] = known ? uv[1] : std::numeric_limits<float>::quiet_NaN();
  }
  return flow;
}

struct FlowFileWriter::Impl {
  H5File file;
  std::optional<H5Table> frame, t, u, v;
};

FlowFileWriter::FlowFileWriter(const std::filesystem::path& path, const FlowInfo& info)
    : impl_(new Impl{H5File::create(path), {}, {}, {}, {}}) {
  H5File& f = impl_->file;
  const auto w = std::uint64_t(info.width), h = std::uint64_t(info.height);
  impl_->frame = f.table<std::uint64_t>("frame", {}, 1024, 1, false);
  impl_->t = f.table<double>("t_s", {2}, 1024, 2, false);
  const std::uint64_t chunk = std::max<std::uint64_t>(1, std::min(h, (1u << 20) / (4 * w)));
  impl_->u = f.table<float>("u_px", {h, w}, 1, chunk, false);
  impl_->v = f.table<float>("v_px", {h, w}, 1, chunk, false);
  f.attribute("/", "format", std::string(kFormat));
  f.attribute("/", "width_px", double(info.width));
  f.attribute("/", "height_px", double(info.height));
  f.attribute("/", "fps", info.fps);
  f.attribute("/", "um_per_px", info.um_per_px.value_or(std::numeric_limits<double>::quiet_NaN()));
  f.attribute("/", "method", info.method);
  f.attribute("/", "source", info.source);
  f.attribute("t_s", "axes", std::string("pair; times of its first and second frame"));
  f.attribute("u_px", "axes", std::string("pair, row, column; px per pair, positive to the right"));
  f.attribute("v_px", "axes", std::string("pair, row, column; px per pair, positive downwards"));
  f.begin_writing();
}
FlowFileWriter::~FlowFileWriter() = default;

void FlowFileWriter::write(std::uint64_t frame, double t0_s, double t1_s, const Flow& flow) {
  const double t[2] = {t0_s, t1_s};
  impl_->u->append<float>(flow.u.px);
  impl_->v->append<float>(flow.v.px);
  impl_->t->append<double>(t);
  impl_->frame->append<std::uint64_t>({&frame, 1});  // written last: its rows count the complete flows
}
std::uint64_t FlowFileWriter::size() const { return impl_->frame->rows(); }
void FlowFileWriter::sync() { impl_->file.sync(); }
void FlowFileWriter::rename_complete(const std::filesystem::path& to) { impl_->file.rename_complete(to); }
void FlowFileWriter::close() {
  impl_->frame.reset();
  impl_->t.reset();
  impl_->u.reset();
  impl_->v.reset();
  impl_->file.close();
}

struct FlowFileReader::Impl {
  H5File file;
  H5Table frame, t, u, v;
  FlowInfo info;
};

FlowFileReader::FlowFileReader(const std::filesystem::path& path) {
  H5File f = H5File::open(path);
  const auto refuse = [&](const char* why) { throw Error(Errc::input, path.string(), why); };
  for (const char* name : {"frame", "t_s", "u_px", "v_px"})
    if (!f.has(name)) refuse("is not a flow file of `faba flow`");
  if (f.text_attribute("/", "format") != kFormat)
    refuse("is a flow file of a different version; this program reads \"faba flow 1\"");
  FlowInfo info;
  const auto number = [&](const char* name) { return f.number_attribute("/", name); };
  info.width = int(number("width_px"));
  info.height = int(number("height_px"));
  info.fps = number("fps");
  if (const double scale = number("um_per_px"); std::isfinite(scale)) info.um_per_px = scale;
  info.method = f.text_attribute("/", "method");
  info.source = f.text_attribute("/", "source");
  H5Table frame = f.table("frame"), t = f.table("t_s"), u = f.table("u_px"), v = f.table("v_px");
  const auto px = std::size_t(std::max(info.width, 0)) * std::size_t(std::max(info.height, 0));
  if (px == 0 || u.row_size() != px || v.row_size() != px || t.row_size() != 2 || frame.row_size() != 1)
    refuse("the size of the flows does not match width_px and height_px");
  impl_ = std::make_unique<Impl>(Impl{std::move(f), frame, t, u, v, info});
}
FlowFileReader::~FlowFileReader() = default;

bool FlowFileReader::recognises(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  char head[8] = {};
  return in.read(head, 8) && std::memcmp(head, "\x89HDF\r\n\x1a\n", 8) == 0;
}
const FlowInfo& FlowFileReader::info() const { return impl_->info; }
std::uint64_t FlowFileReader::size() const { return impl_->frame.rows(); }

void FlowFileReader::read(std::uint64_t index, std::uint64_t& frame, double& t0_s, double& t1_s,
                          Flow& flow) const {
  const FlowInfo& info = impl_->info;
  if (flow.width() != info.width || flow.height() != info.height)
    flow.u = flow.v = GrayF(info.width, info.height);
  double t[2];
  impl_->frame.read<std::uint64_t>(index, {&frame, 1});
  impl_->t.read<double>(index, t);
  impl_->u.read<float>(index, flow.u.px);
  impl_->v.read<float>(index, flow.v.px);
  t0_s = t[0];
  t1_s = t[1];
}

}  // namespace faba
