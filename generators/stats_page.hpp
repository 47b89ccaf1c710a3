#pragma once

#include "ensonify/generators/dataset_stats.hpp"
#include "ensonify/output/report_page.hpp"

namespace ensonify {

/// What is in a dataset, for a reader: splits and places, some frames, masks, levels, ranges, poses, what was sampled,
/// frames that are nearly equal.
ReportPage stats_page(const DatasetStats& stats, const ReportSource& source);

}  // namespace ensonify
