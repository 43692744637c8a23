#include "vision/files/tiff/tiff_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string>
#include <system_error>
#include <vector>

#include "core/error.h"

namespace faba {
namespace {

static_assert(std::endian::native == std::endian::little, "the pixels are written as they are in memory");

constexpr std::uint64_t kFirstPixel = 16;  // after the header of a BigTIFF, which is the longer one
constexpr std::size_t kPiece = 1u << 20;   // bytes of directories that are written together
enum Type : std::uint16_t { kText = 2, kShort = 3, kLong = 4, kRational = 5, kLong8 = 16 };
constexpr std::size_t size_of(Type type) {
  return type == kText ? 1 : type == kShort ? 2 : type == kLong ? 4 : 8;
}

template <class Integer>
void put(std::string& out, Integer value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

// A number in the width of the format: 4 bytes, or 8 in a BigTIFF.
void put_offset(std::string& out, std::uint64_t value, bool big) {
  big ? put(out, value) : put(out, std::uint32_t(value));
}

/// A directory of a TIFF file: the tags of one page, in ascending order.
class Directory {
 public:
  explicit Directory(bool big) : big_(big) {}
  void add(std::uint16_t tag, Type type, const std::vector<std::uint64_t>& numbers) {
    std::string bytes;
    for (const std::uint64_t n : numbers)
      for (std::size_t i = 0; i < size_of(type); ++i) bytes += char(n >> (8 * i));
    entries_.push_back({tag, type, std::move(bytes)});
  }
  void add(std::uint16_t tag, const std::string& text) { entries_.push_back({tag, kText, text + '\0'}); }

  /// The bytes of the directory if it is at `at`, with its long values behind it. `last`: no other directory
  /// follows it.
  std::string bytes(std::uint64_t at, bool last) const {
    const std::size_t inline_bytes = big_ ? 8 : 4;
    const std::size_t length = (big_ ? 8 : 2) + entries_.size() * (big_ ? 20 : 12) + inline_bytes;
    std::string out, values;
    big_ ? put(out, std::uint64_t(entries_.size())) : put(out, std::uint16_t(entries_.size()));
    for (const Entry& e : entries_) {
      put(out, e.tag);
      put(out, std::uint16_t(e.type));
      put_offset(out, e.bytes.size() / size_of(e.type), big_);
      if (e.bytes.size() <= inline_bytes) {
        out += e.bytes + std::string(inline_bytes - e.bytes.size(), '\0');
        continue;
      }
      put_offset(out, at + length + values.size(), big_);
      values += e.bytes;
      if (values.size() % 2) values += '\0';
    }
    put_offset(out, last ? 0 : at + length + values.size(), big_);
    return out + values;
  }

 private:
  struct Entry {
    std::uint16_t tag;
    Type type;
    std::string bytes;
  };
  bool big_;
  std::vector<Entry> entries_;
};

// Pixels per um as a fraction of two 32-bit numbers: short decimal scales are exact.
std::uint64_t resolution(double um_per_px) {
  std::uint32_t pixels = 1000000000;
  while (um_per_px * pixels > 4e9) pixels /= 10;
  const auto micrometres = std::max<std::uint32_t>(1, std::uint32_t(std::llround(um_per_px * pixels)));
  return pixels | std::uint64_t(micrometres) << 32;
}

/// A page whose pixels are at `offset`.
struct Page {
  int width, height;
  TiffPixels pixels;
  std::uint64_t offset, bytes;
  std::optional<double> um_per_px;
};

// `description`: of the stack, for its first page; else empty.
Directory directory_of(const Page& page, const std::string& description, bool big) {
  const std::size_t samples = page.pixels == TiffPixels::colour ? 3 : 1;
  const std::uint64_t bits = page.pixels == TiffPixels::grey16       ? 16
                             : page.pixels == TiffPixels::grey_float ? 32
                                                                     : 8;
  const std::uint64_t number_format = page.pixels == TiffPixels::grey_float ? 3 : 1;
  Directory d(big);
  d.add(256, kLong, {std::uint64_t(page.width)});
  d.add(257, kLong, {std::uint64_t(page.height)});
  d.add(258, kShort, std::vector<std::uint64_t>(samples, bits));
  d.add(259, kShort, {1});                        // no compression
  d.add(262, kShort, {samples == 3 ? 2ull : 1});  // RGB; black is 0
  if (!description.empty()) d.add(270, description);
  d.add(273, big ? kLong8 : kLong, {page.offset});
  d.add(277, kShort, {samples});
  d.add(278, kLong, {std::uint64_t(page.height)});  // one strip
  d.add(279, big ? kLong8 : kLong, {page.bytes});
  if (page.um_per_px) {
    d.add(282, kRational, {resolution(*page.um_per_px)});
    d.add(283, kRational, {resolution(*page.um_per_px)});
    d.add(296, kShort, {1});  // the unit is in the description
  }
  d.add(339, kShort, std::vector<std::uint64_t>(samples, number_format));
  return d;
}

const char* ome_type(TiffPixels pixels) {
  return pixels == TiffPixels::grey16 ? "uint16" : pixels == TiffPixels::grey_float ? "float" : "uint8";
}

std::string ome_description(int width, int height, std::uint64_t pages, TiffPixels pixels,
                            const TiffScale& scale) {
  const int samples = pixels == TiffPixels::colour ? 3 : 1;
  std::string stated;
  if (scale.um_per_px)
    stated += fmt::format(
        " PhysicalSizeX=\"{0}\" PhysicalSizeXUnit=\"\u00b5m\" PhysicalSizeY=\"{0}\" "
        "PhysicalSizeYUnit=\"\u00b5m\"",
        *scale.um_per_px);
  if (scale.frame_s) stated += fmt::format(" TimeIncrement=\"{}\" TimeIncrementUnit=\"s\"", *scale.frame_s);
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME "
      "xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\" "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://www.openmicroscopy.org/Schemas/OME/2016-06 "
      "http://www.openmicroscopy.org/Schemas/OME/2016-06/ome.xsd\" Creator=\"faba {}\"><Image ID=\"Image:0\">"
      "<Pixels ID=\"Pixels:0\" DimensionOrder=\"XYCZT\" Type=\"{}\" SizeX=\"{}\" SizeY=\"{}\" SizeC=\"{}\" "
      "SizeZ=\"1\" SizeT=\"{}\" BigEndian=\"false\" Interleaved=\"{}\"{}><Channel ID=\"Channel:0:0\" "
      "SamplesPerPixel=\"{}\"/><TiffData IFD=\"0\" PlaneCount=\"{}\"/></Pixels></Image></OME>",
      FABA_VERSION, ome_type(pixels), width, height, samples, pages, samples > 1, stated, samples, pages);
}

std::string imagej_description(std::uint64_t pages, const TiffScale& scale) {
  std::string text = fmt::format("ImageJ=1.54f\nimages={0}\nframes={0}\nhyperstack=true\n", pages);
  if (scale.um_per_px) text += "unit=micron\n";
  if (scale.frame_s)
    text += fmt::format("finterval={}\ntunit=s\nfps={}\n", *scale.frame_s, 1 / *scale.frame_s);
  return text + "loop=false\n";
}

}  // namespace

std::optional<TiffKind> tiff_kind(const std::filesystem::path& file) {
  const std::string extension = file.extension().string();
  if (extension != ".tif" && extension != ".tiff") return std::nullopt;
  return file.stem().extension() == ".ome" ? TiffKind::ome : TiffKind::imagej;
}

TiffWriter::TiffWriter(const std::filesystem::path& file, int width, int height, TiffPixels pixels,
                       std::uint64_t most_classic)
    : path_(file),
      file_(temporary_name(file), 0, file),
      width_(width),
      height_(height),
      pixels_(pixels),
      most_classic_(most_classic) {
  const std::uint64_t bytes = pixels == TiffPixels::grey8    ? 1
                              : pixels == TiffPixels::grey16 ? 2
                              : pixels == TiffPixels::colour ? 3
                                                             : 4;
  page_bytes_ = bytes * std::uint64_t(width) * std::uint64_t(height);
  file_.append(std::string(kFirstPixel, '\0'));
}

TiffWriter::~TiffWriter() {
  std::error_code ignored;
  if (!complete_) std::filesystem::remove(temporary_name(path_), ignored);
}

template <class Pixel>
void TiffWriter::append(const Image<Pixel>& page, TiffPixels pixels) {
  static_assert(sizeof(Rgb) == 3);
  if (page.width != width_ || page.height != height_ || pixels != pixels_)
    throw Error(Errc::internal, path_.string(), "a page differs in size or type from the stack");
  append_bytes(page.px.data(), page.px.size() * sizeof(Pixel));
}
template void TiffWriter::append(const Gray8&, TiffPixels);
template void TiffWriter::append(const Image<std::uint16_t>&, TiffPixels);
template void TiffWriter::append(const GrayF&, TiffPixels);
template void TiffWriter::append(const RgbImage&, TiffPixels);

void TiffWriter::append_bytes(const void* bytes, std::uint64_t size) {
  file_.append({static_cast<const std::uint8_t*>(bytes), size});
  ++pages_;
}

bool TiffWriter::finish(TiffKind kind, const TiffScale& scale) {
  if (pages_ == 0) throw Error(Errc::internal, path_.string(), "contains no frames; it cannot be finished");
  const std::string description = kind == TiffKind::ome
                                      ? ome_description(width_, height_, pages_, pixels_, scale)
                                      : imagej_description(pages_, scale);
  constexpr std::uint64_t kMostDirectory = 256;  // bytes, without the description
  const std::uint64_t start = file_.size() + file_.size() % 2;
  const bool big = start + pages_ * kMostDirectory + description.size() > most_classic_;
  std::string piece(start - file_.size(), '\0');
  Page page{width_, height_, pixels_, kFirstPixel, page_bytes_, scale.um_per_px};
  for (std::uint64_t i = 0; i < pages_; ++i, page.offset += page.bytes) {
    const Directory d = directory_of(page, i == 0 ? description : "", big);
    piece += d.bytes(file_.size() + piece.size(), i + 1 == pages_);
    if (piece.size() < kPiece && i + 1 < pages_) continue;
    file_.append(piece);
    piece.clear();
  }
  std::string header = "II";
  put(header, std::uint16_t(big ? 43 : 42));
  if (big) put(header, std::uint32_t(8));  // bytes of an offset
  put_offset(header, start, big);
  file_.replace(0, {reinterpret_cast<const std::uint8_t*>(header.data()), header.size()});
  file_.sync();
  file_.close();
  rename_complete(temporary_name(path_), path_);
  complete_ = true;
  return big;
}

}  // namespace faba
