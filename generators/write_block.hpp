#pragma once

#include <functional>
#include <string>
#include <vector>

#include "ensonify/generators/dataset_plan.hpp"
#include "ensonify/generators/frame_pixels.hpp"
#include "ensonify/generators/observed_record.hpp"

namespace ensonify {

/// One line of metadata.jsonl (without newline) for a frame.
std::string metadata_line(const FrameMaker& maker, const FramePose& pose, const SonarModel& sonar,
                          const Image2<std::uint8_t>& mask);

/// SHA-256 of what a frame says, whatever its files: its pixels (16 bits: low byte first) and its metadata line.
std::string content_hash(const FramePixels& pixels, const std::string& line);

struct FrameRecord {
  int index = 0;
  std::string sha256;
  std::string line;
};

/// Writes the files of one frame in a folder dataset; returns its record.
FrameRecord write_frame(const FrameMaker& maker, const DatasetPaths& paths, const Frame& frame);

/// Makes and writes a block, then what it observed and its record in the state folder, which marks it as done. Calls
/// after_frame() after each; where that returns false, stops and returns false, and the block counts as not done.
bool write_block(const FrameMaker& maker, const DatasetPaths& paths, const Block& block, SampleFormat format,
                 const std::function<bool()>& after_frame);

/// The record of a finished block; empty where it is not finished. Throws DataError on a broken record.
std::vector<FrameRecord> read_block_record(const DatasetPaths& paths, const Block& block);

/// What the frames of a finished block observed. Throws DataError where that is missing or broken.
std::vector<ObservedCells> read_observed(const DatasetPaths& paths, const Block& block);

}  // namespace ensonify
