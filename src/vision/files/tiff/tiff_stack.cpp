#include "vision/files/tiff/tiff_stack.h"

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "core/error.h"
#include "vision/image/grey_of.h"

namespace faba {
namespace {

constexpr std::uint64_t kMaxPagePixels = std::uint64_t{1} << 28;  // limit for corrupt or malicious headers
constexpr tmsize_t kMaxBuffer = tmsize_t{1} << 30;                // bytes, limit of one allocation

// Only the first error of libtiff is reported; the later ones follow from it.
int keep_first_tiff_error(TIFF*, void* message_pointer, const char*, const char* format, va_list arguments) {
  auto& message = *static_cast<std::string*>(message_pointer);
  if (message.empty()) {
    std::array<char, 256> line{};
    std::vsnprintf(line.data(), line.size(), format, arguments);
    message = line.data();
    while (!message.empty() && message.back() == '.') message.pop_back();
  }
  return 1;  // handled: nothing is printed
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) { return 1; }

struct Layout {
  std::uint32_t width = 0, height = 0;
  std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK;
  bool planar = false, tiled = false;

  int colours() const { return photometric == PHOTOMETRIC_RGB ? 3 : 1; }
};

// Whether the samples are read directly; other layouts are converted by libtiff to 8-bit colour.
bool is_direct(const Layout& page) {
  const bool grey = page.photometric == PHOTOMETRIC_MINISBLACK || page.photometric == PHOTOMETRIC_MINISWHITE;
  if (!grey && (page.photometric != PHOTOMETRIC_RGB || page.samples < 3)) return false;
  switch (page.format) {
    case SAMPLEFORMAT_UINT:
      return (page.bits >= 8 && page.bits <= 16) || page.bits == 32;
    case SAMPLEFORMAT_INT:
      return page.bits == 8 || page.bits == 16 || page.bits == 32;
    case SAMPLEFORMAT_IEEEFP:
      return page.bits == 32 || page.bits == 64;
    default:
      return false;
  }
}

template <class Sample>
void widen(const std::uint8_t* bytes, std::vector<float>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    Sample sample;
    std::memcpy(&sample, bytes + i * sizeof sample, sizeof sample);
    values[i] = static_cast<float>(sample);
  }
}

// Samples of 9 to 15 bits are packed, most significant bit first.
void unpack(const std::uint8_t* bytes, unsigned bits, std::vector<float>& values) {
  std::uint32_t store = 0;
  unsigned held = 0;
  for (float& value : values) {
    for (; held < bits; held += 8) store = (store << 8) | *bytes++;
    held -= bits;
    value = static_cast<float>((store >> held) & ((1U << bits) - 1U));
  }
}

void to_float(const Layout& page, const std::uint8_t* bytes, std::vector<float>& values) {
  const bool is_signed = page.format == SAMPLEFORMAT_INT;
  if (page.format == SAMPLEFORMAT_IEEEFP) {
    page.bits == 32 ? widen<float>(bytes, values) : widen<double>(bytes, values);
  } else if (page.bits == 8) {
    is_signed ? widen<std::int8_t>(bytes, values) : widen<std::uint8_t>(bytes, values);
  } else if (page.bits == 16) {
    is_signed ? widen<std::int16_t>(bytes, values) : widen<std::uint16_t>(bytes, values);
  } else if (page.bits == 32) {
    is_signed ? widen<std::int32_t>(bytes, values) : widen<std::uint32_t>(bytes, values);
  } else {
    unpack(bytes, page.bits, values);
  }
}

}  // namespace

struct TiffStack::Impl {
  struct Close {
    void operator()(TIFF* open) const { TIFFClose(open); }
  };

  std::filesystem::path path;
  std::string message;  // first error of libtiff since the last clear()
  std::unique_ptr<TIFF, Close> tiff;
  Layout page;  // layout of the next page
  int first_width = 0, first_height = 0, first_bits = 0;
  PictureMetadata metadata;
  bool at_end = false, page_unread = true;
  int page_number = 1;          // of the file, from 1
  std::int64_t page_index = 0;  // from 0, without reduced-resolution pages
  std::vector<std::uint8_t> buffer;
  std::vector<float> values;

  [[noreturn]] void refuse(const std::string& why) const {
    const std::string which = page_number > 1 ? "page " + std::to_string(page_number) + ": " : "";
    throw Error(Errc::input, path.string(), which + why + (message.empty() ? "" : " (" + message + ")"));
  }
  void open();
  void read_layout();
  void advance();
  void convert(const std::uint8_t* bytes, std::uint32_t count, float* out);
  void read_strips(std::uint16_t plane, GrayF& out);
  void read_tiles(std::uint16_t plane, GrayF& out);
  void read_samples(GrayF& out);
  void read_colour(GrayF& out);
  std::vector<std::uint32_t> raster();
};

void TiffStack::Impl::open() {
  const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                 &TIFFOpenOptionsFree);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), keep_first_tiff_error, &message);
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore_warning, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxBuffer);
  tiff.reset(TIFFOpenExt(path.c_str(), "r", options.get()));
  if (!tiff) refuse("is not a valid TIFF file");
  read_layout();
  first_width = static_cast<int>(page.width);
  first_height = static_cast<int>(page.height);
  first_bits = is_direct(page) ? page.bits : 8;

  TiffDescription stated;
  const char* text = nullptr;
  if (TIFFGetField(tiff.get(), TIFFTAG_IMAGEDESCRIPTION, &text) == 1 && text != nullptr) stated.text = text;
  float across = 0, down = 0;
  if (TIFFGetField(tiff.get(), TIFFTAG_XRESOLUTION, &across) == 1) stated.x_resolution = double(across);
  if (TIFFGetField(tiff.get(), TIFFTAG_YRESOLUTION, &down) == 1) stated.y_resolution = double(down);
  metadata = tiff_metadata(stated, path);
}

void TiffStack::Impl::read_layout() {
  TIFF* file = tiff.get();
  page = {};
  TIFFGetField(file, TIFFTAG_IMAGEWIDTH, &page.width);
  TIFFGetField(file, TIFFTAG_IMAGELENGTH, &page.height);
  TIFFGetFieldDefaulted(file, TIFFTAG_BITSPERSAMPLE, &page.bits);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
  TIFFGetFieldDefaulted(file, TIFFTAG_SAMPLEFORMAT, &page.format);
  TIFFGetField(file, TIFFTAG_PHOTOMETRIC, &page.photometric);
  if (page.format == SAMPLEFORMAT_VOID) page.format = SAMPLEFORMAT_UINT;
  std::uint16_t planar = PLANARCONFIG_CONTIG;
  TIFFGetFieldDefaulted(file, TIFFTAG_PLANARCONFIG, &planar);
  page.planar = planar == PLANARCONFIG_SEPARATE;
  page.tiled = TIFFIsTiled(file) != 0;
  if (page.width == 0 || page.height == 0) refuse("has no picture size");
  if (std::uint64_t{page.width} * page.height > kMaxPagePixels) {
    refuse("picture size " + std::to_string(page.width) + " x " + std::to_string(page.height) +
           " px exceeds the maximum of 2^28 pixels; crop it");
  }
}

void TiffStack::Impl::advance() {
  std::uint32_t kind = 0;
  do {
    at_end = TIFFLastDirectory(tiff.get()) != 0;
    if (at_end) return;
    ++page_number;
    if (TIFFReadDirectory(tiff.get()) == 0) refuse("is missing; the file is truncated");
    kind = 0;
    TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_SUBFILETYPE, &kind);
  } while ((kind & FILETYPE_REDUCEDIMAGE) != 0);
  ++page_index;
  read_layout();
}

// Converts one row or part of a row: all channels when interleaved, else one plane.
void TiffStack::Impl::convert(const std::uint8_t* bytes, std::uint32_t count, float* out) {
  const std::size_t step = page.planar ? 1 : page.samples;
  values.resize(count * step);
  to_float(page, bytes, values);
  const bool interleaved_colour = page.colours() == 3 && !page.planar;
  for (std::size_t i = 0; i < count; ++i) {
    const float* sample = &values[i * step];
    out[i] = interleaved_colour ? grey_of(sample[0], sample[1], sample[2]) : sample[0];
  }
}

void TiffStack::Impl::read_strips(std::uint16_t plane, GrayF& out) {
  const tmsize_t size = TIFFScanlineSize(tiff.get());
  if (size <= 0 || size > kMaxBuffer) refuse("row size is invalid or exceeds 1 GiB");
  buffer.resize(static_cast<std::size_t>(size));
  for (std::uint32_t row = 0; row < page.height; ++row) {
    if (TIFFReadScanline(tiff.get(), buffer.data(), row, plane) != 1) {
      refuse("row " + std::to_string(row) + " cannot be read; the file is damaged or truncated");
    }
    convert(buffer.data(), page.width, &out.at(0, static_cast<int>(row)));
  }
}

void TiffStack::Impl::read_tiles(std::uint16_t plane, GrayF& out) {
  std::uint32_t tile_width = 0, tile_height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff.get(), TIFFTAG_TILELENGTH, &tile_height);
  const tmsize_t size = TIFFTileSize(tiff.get()), row_size = TIFFTileRowSize(tiff.get());
  if (tile_width == 0 || tile_height == 0 || size <= 0 || size > kMaxBuffer) {
    refuse("tile size is invalid or exceeds 1 GiB");
  }
  buffer.resize(static_cast<std::size_t>(size));
  for (std::uint32_t top = 0; top < page.height; top += tile_height) {
    for (std::uint32_t left = 0; left < page.width; left += tile_width) {
      if (TIFFReadTile(tiff.get(), buffer.data(), left, top, 0, plane) < 0) {
        refuse("a tile cannot be read; the file is damaged or truncated");
      }
      const std::uint32_t columns = std::min(tile_width, page.width - left);
      const std::uint32_t rows = std::min(tile_height, page.height - top);
      for (std::uint32_t row = 0; row < rows; ++row) {
        convert(buffer.data() + static_cast<tmsize_t>(row) * row_size, columns,
                &out.at(static_cast<int>(left), static_cast<int>(top + row)));
      }
    }
  }
}

void TiffStack::Impl::read_samples(GrayF& out) {
  const auto read_plane = [&](std::uint16_t plane, GrayF& into) {
    page.tiled ? read_tiles(plane, into) : read_strips(plane, into);
  };
  if (page.planar && page.colours() == 3) {
    GrayF green(out.width, out.height), blue(out.width, out.height);
    read_plane(0, out);
    read_plane(1, green);
    read_plane(2, blue);
    for (std::size_t i = 0; i < out.px.size(); ++i) out.px[i] = grey_of(out.px[i], green.px[i], blue.px[i]);
  } else {
    read_plane(0, out);
  }
  if (page.photometric == PHOTOMETRIC_MINISWHITE) {
    if (page.format != SAMPLEFORMAT_UINT)
      refuse(
          "white is 0 (MINISWHITE) in signed or float samples, so black is undefined; save the file as "
          "MINISBLACK");
    const auto black = static_cast<float>((std::uint64_t{1} << page.bits) - 1);
    for (float& value : out.px) value = black - value;
  }
}

// 8-bit colours as packed by libtiff, pixels in storage order.
std::vector<std::uint32_t> TiffStack::Impl::raster() {
  std::array<char, 1024> why{};
  if (TIFFRGBAImageOK(tiff.get(), why.data()) == 0) {
    refuse(std::string("TIFF layout not supported: ") + why.data() + "; save it as 8- or 16-bit grey");
  }
  std::vector<std::uint32_t> colours(std::size_t{page.width} * page.height);
  std::uint16_t as_stored = ORIENTATION_TOPLEFT;
  TIFFGetFieldDefaulted(tiff.get(), TIFFTAG_ORIENTATION, &as_stored);
  if (TIFFReadRGBAImageOriented(tiff.get(), page.width, page.height, colours.data(), as_stored, 1) != 1) {
    refuse("cannot be read; the file is damaged or truncated");
  }
  return colours;
}

void TiffStack::Impl::read_colour(GrayF& out) {
  const std::vector<std::uint32_t> colours = raster();
  std::transform(colours.begin(), colours.end(), out.px.begin(), [](std::uint32_t v) {
    return grey_of(static_cast<float>(TIFFGetR(v)), static_cast<float>(TIFFGetG(v)),
                   static_cast<float>(TIFFGetB(v)));
  });
}

void TiffStack::read_colours(RgbImage& page) {
  Impl& self = *impl_;
  page = {};
  const std::uint16_t kind = self.page.photometric;
  const bool grey = kind == PHOTOMETRIC_MINISBLACK || kind == PHOTOMETRIC_MINISWHITE;
  const bool integers =
      self.page.format == SAMPLEFORMAT_UINT && (self.page.bits <= 8 || self.page.bits == 16);
  if (grey || !integers) return;
  const std::vector<std::uint32_t> colours = self.raster();
  page = RgbImage(static_cast<int>(self.page.width), static_cast<int>(self.page.height));
  std::transform(colours.begin(), colours.end(), page.px.begin(), [](std::uint32_t v) {
    return Rgb{std::uint8_t(TIFFGetR(v)), std::uint8_t(TIFFGetG(v)), std::uint8_t(TIFFGetB(v))};
  });
}

TiffStack::TiffStack(const std::filesystem::path& path) : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->open();
}
TiffStack::~TiffStack() = default;
TiffStack::TiffStack(TiffStack&&) noexcept = default;
TiffStack& TiffStack::operator=(TiffStack&&) noexcept = default;

int TiffStack::width() const { return impl_->first_width; }
int TiffStack::height() const { return impl_->first_height; }
int TiffStack::bits() const { return impl_->first_bits; }
const PictureMetadata& TiffStack::metadata() const { return impl_->metadata; }

int TiffStack::pages() const {
  const auto count = TIFFNumberOfDirectories(impl_->tiff.get());
  impl_->message.clear();
  return static_cast<int>(count);
}

std::int64_t TiffStack::seek(std::int64_t page) {
  Impl& self = *impl_;
  self.message.clear();
  if (page < self.page_index || self.at_end) {
    if (TIFFSetDirectory(self.tiff.get(), 0) == 0) self.refuse("the first page cannot be read");
    self.at_end = false;
    self.page_number = 1;
    self.page_index = 0;
    self.read_layout();
  }
  while (self.page_index < page && TIFFLastDirectory(self.tiff.get()) == 0) self.advance();
  self.page_unread = true;
  return self.page_index;
}

bool TiffStack::read(GrayF& page) {
  Impl& self = *impl_;
  self.message.clear();
  if (!self.page_unread && !self.at_end) self.advance();
  if (self.at_end) return false;
  self.page_unread = false;
  page.width = static_cast<int>(self.page.width);
  page.height = static_cast<int>(self.page.height);
  page.px.resize(std::size_t{self.page.width} * self.page.height);
  is_direct(self.page) ? self.read_samples(page) : self.read_colour(page);
  return true;
}

}  // namespace faba
