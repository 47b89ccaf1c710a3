#include "ensonify/output/exr.hpp"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>

#include "ensonify/core/error.hpp"
#include "ensonify/output/atomic_file.hpp"

namespace ensonify {
namespace {

Imf::Slice slice_of(float* pixels, int columns) {
  return Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(pixels), sizeof(float),
                    sizeof(float) * static_cast<std::size_t>(columns));
}

}  // namespace

void write_exr(const std::filesystem::path& path, const std::vector<Channel>& channels, const std::string& comment) {
  const int rows = channels.front().second.rows();
  const int columns = channels.front().second.columns();
  Imf::Header header(columns, rows);
  header.compression() = Imf::ZIP_COMPRESSION;
  Imf::addComments(header, comment);
  Imf::FrameBuffer buffer;
  for (const auto& [name, image] : channels) {
    if (image.rows() != rows || image.columns() != columns) {
      throw DataError(fmt::format("{}: channel {} differs in size", path.string(), name));
    }
    header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    buffer.insert(name, slice_of(const_cast<float*>(image.pixels().data()), columns));
  }
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    try {
      Imf::OutputFile file(temporary.c_str(), header, 1);
      file.setFrameBuffer(buffer);
      file.writePixels(rows);
    } catch (const std::exception& e) {
      throw disk_error(path, e.what());
    }
  });
}

std::vector<Channel> read_exr(const std::filesystem::path& path) {
  try {
    Imf::InputFile file(path.c_str(), 1);
    const Imath::Box2i window = file.header().dataWindow();
    const int columns = window.max.x - window.min.x + 1;
    const int rows = window.max.y - window.min.y + 1;
    if (static_cast<std::int64_t>(columns) * rows > (1 << 28)) {
      throw DataError(fmt::format("{}: {} x {} pixels is too large", path.string(), columns, rows));
    }
    std::vector<Channel> channels;
    for (auto c = file.header().channels().begin(); c != file.header().channels().end(); ++c) {
      channels.emplace_back(c.name(), Image2<float>(rows, columns));
    }
    Imf::FrameBuffer buffer;
    for (auto& [name, image] : channels) {
      float* origin = image.pixels().data() - window.min.x - static_cast<std::ptrdiff_t>(window.min.y) * columns;
      buffer.insert(name, slice_of(origin, columns));
    }
    file.setFrameBuffer(buffer);
    file.readPixels(window.min.y, window.max.y);
    return channels;
  } catch (const DataError&) {
    throw;
  } catch (const std::exception& e) {
    throw DataError(fmt::format("{}: no readable OpenEXR file: {}", path.string(), e.what()));
  }
}

}  // namespace ensonify
