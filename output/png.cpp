#include "ensonify/output/png.hpp"

#include <fmt/format.h>
#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <string_view>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

constexpr std::array<std::uint8_t, 8> signature{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr int thorough = 9;
/// Of IHDR, PNG specification 11.2.2.
enum class ColourType : std::uint8_t { grey = 0, colour = 2 };

void put_u32(std::vector<std::uint8_t>& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t get_u32(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 | std::uint32_t{bytes[2]} << 8 | bytes[3];
}

/// Length, type, data, CRC of type and data (PNG specification 5.3).
void put_chunk(std::vector<std::uint8_t>& out, std::string_view type, std::span<const std::uint8_t> data) {
  put_u32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  put_u32(out, libdeflate_crc32(0, out.data() + start, out.size() - start));
}

std::vector<std::uint8_t> pack_small(std::span<const std::uint8_t> bytes) {
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(thorough), libdeflate_free_compressor);
  std::vector<std::uint8_t> packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
  return packed;
}

/// ISA-L's level 1: four times as fast as libdeflate's fastest, and 5 % larger. Its fast loop takes the hash of the
/// third byte of a stream from a register that still holds the stream's address (2.30, igzip_icf_body_h1_gr_bt.asm,
/// write_first_byte), so that the packed bytes depend on where the stream lies. The loop for short input, which 16
/// bytes or fewer never leave, has it right: the first bytes go through that one.
std::vector<std::uint8_t> pack_fast(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t headers = 1024, first = 8;
  std::vector<std::uint8_t> packed(bytes.size() + bytes.size() / 16 + headers), tables(ISAL_DEF_LVL1_DEFAULT);
  const auto stream = std::make_unique<isal_zstream>();
  isal_deflate_init(stream.get());
  stream->level = 1;
  stream->level_buf = tables.data();
  stream->level_buf_size = static_cast<std::uint32_t>(tables.size());
  stream->gzip_flag = IGZIP_ZLIB;
  stream->next_in = const_cast<std::uint8_t*>(bytes.data());  // read only; the type is C's
  stream->next_out = packed.data();
  stream->avail_out = static_cast<std::uint32_t>(packed.size());
  const auto pack = [&](std::size_t n, std::uint16_t flush, bool last) {
    stream->flush = flush;
    stream->end_of_stream = last;
    stream->avail_in = static_cast<std::uint32_t>(n);
    return isal_deflate(stream.get()) == COMP_OK && stream->avail_in == 0;
  };
  const std::size_t start = std::min(first, bytes.size());
  const bool packs = pack(start, SYNC_FLUSH, false) && pack(bytes.size() - start, NO_FLUSH, true);
  if (!packs || stream->internal_state.state != ZSTATE_END) return pack_small(bytes);
  packed.resize(stream->total_out);
  return packed;
}

std::vector<std::uint8_t> encode(std::span<const std::uint8_t> scanlines, int width, int height, int bits,
                                 ColourType type = ColourType::grey) {
  const std::vector<std::uint8_t> packed = type == ColourType::grey ? pack_fast(scanlines) : pack_small(scanlines);
  std::vector<std::uint8_t> header;
  put_u32(header, static_cast<std::uint32_t>(width));
  put_u32(header, static_cast<std::uint32_t>(height));
  // Bits, colour type, deflate, the one filter method, no interlace.
  header.insert(header.end(), {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(type), 0, 0, 0});

  std::vector<std::uint8_t> png(signature.begin(), signature.end());
  png.reserve(packed.size() + 64);
  put_chunk(png, "IHDR", header);
  put_chunk(png, "IDAT", packed);
  put_chunk(png, "IEND", {});
  return png;
}

/// Whether the chunks follow each other to the end of the file, each with its checksum. libpng pads a truncated image
/// with zeros, overlooks what follows the end, and only warns.
bool is_whole(std::span<const std::uint8_t> bytes) {
  constexpr std::size_t around_data = 12;  // length, type, CRC
  bytes = bytes.subspan(signature.size());
  for (bool ended = false; !bytes.empty() || !ended;) {
    if (ended || bytes.size() < around_data) return false;
    const std::size_t data = get_u32(bytes.data());
    if (data > bytes.size() - around_data) return false;
    if (libdeflate_crc32(0, bytes.data() + 4, data + 4) != get_u32(bytes.data() + 8 + data)) return false;
    ended = std::memcmp(bytes.data() + 4, "IEND", 4) == 0;
    bytes = bytes.subspan(data + around_data);
  }
  return true;
}

}  // namespace

std::vector<std::uint8_t> encode_png(const Image2<std::uint8_t>& image) {
  std::vector<std::uint8_t> scanlines;
  scanlines.reserve(image.size() + static_cast<std::size_t>(image.rows()));
  for (int r = 0; r < image.rows(); ++r) {
    scanlines.push_back(0);  // filter type: none
    scanlines.insert(scanlines.end(), image.row(r).begin(), image.row(r).end());
  }
  return encode(scanlines, image.columns(), image.rows(), 8);
}

std::vector<std::uint8_t> encode_png(const Image2<std::uint16_t>& image) {
  std::vector<std::uint8_t> scanlines;
  scanlines.reserve(2 * image.size() + static_cast<std::size_t>(image.rows()));
  for (int r = 0; r < image.rows(); ++r) {
    scanlines.push_back(0);
    for (const std::uint16_t v : image.row(r)) {
      scanlines.push_back(static_cast<std::uint8_t>(v >> 8));
      scanlines.push_back(static_cast<std::uint8_t>(v & 0xff));
    }
  }
  return encode(scanlines, image.columns(), image.rows(), 16);
}

std::vector<std::uint8_t> encode_png(const Image2<Rgb>& image) {
  std::vector<std::uint8_t> scanlines;
  scanlines.reserve(3 * image.size() + static_cast<std::size_t>(image.rows()));
  for (int r = 0; r < image.rows(); ++r) {
    scanlines.push_back(1);  // filter type: difference to the pixel before
    Rgb before;
    for (const Rgb p : image.row(r)) {
      scanlines.push_back(static_cast<std::uint8_t>(p.red - before.red));
      scanlines.push_back(static_cast<std::uint8_t>(p.green - before.green));
      scanlines.push_back(static_cast<std::uint8_t>(p.blue - before.blue));
      before = p;
    }
  }
  return encode(scanlines, image.columns(), image.rows(), 8, ColourType::colour);
}

template <typename Grey>
Image2<Grey> decode_png(std::span<const std::uint8_t> bytes, const std::filesystem::path& name) {
  constexpr std::size_t header_bytes = 33;
  if (bytes.size() < header_bytes || !std::equal(signature.begin(), signature.end(), bytes.begin())) {
    throw DataError(fmt::format("{}: no PNG file", name.string()));
  }
  const std::uint64_t pixels = std::uint64_t{get_u32(bytes.data() + 16)} * get_u32(bytes.data() + 20);
  if (pixels == 0 || pixels > (1u << 28)) throw DataError(fmt::format("{}: {} pixels", name.string(), pixels));
  if (!is_whole(bytes)) throw DataError(fmt::format("{}: the PNG file is cut short or damaged", name.string()));
  cv::Mat decoded;
  try {
    decoded = cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8U, const_cast<std::uint8_t*>(bytes.data())),
                           cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception& e) {
    throw DataError(fmt::format("{}: broken PNG file: {}", name.string(), e.what()));
  }
  if (decoded.empty()) throw DataError(fmt::format("{}: broken PNG file", name.string()));
  if (decoded.channels() != 1 || decoded.elemSize() != sizeof(Grey)) {
    throw DataError(fmt::format("{}: must be a greyscale PNG of {} bits, not {} of {} bits", name.string(),
                                8 * sizeof(Grey), decoded.channels() == 1 ? "grey" : "colours",
                                8 * decoded.elemSize1()));
  }
  Image2<Grey> image(decoded.rows, decoded.cols);
  for (int r = 0; r < decoded.rows; ++r) std::memcpy(image.row(r).data(), decoded.ptr(r), image.row(r).size_bytes());
  return image;
}

template Image2<std::uint8_t> decode_png(std::span<const std::uint8_t>, const std::filesystem::path&);
template Image2<std::uint16_t> decode_png(std::span<const std::uint8_t>, const std::filesystem::path&);

Image2<std::uint8_t> read_png(const std::filesystem::path& path) {
  return decode_png<std::uint8_t>(read_file(path), path);
}

}  // namespace ensonify
