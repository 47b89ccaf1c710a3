#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "ensonify/generators/dataset_stats.hpp"
#include "ensonify/output/report_table.hpp"

/// The figures of a dataset as tables of its report.
namespace ensonify {

ReportTable split_table(const DatasetStats& stats);

/// The places of one split, or of all where it is empty.
ReportTable place_table(const DatasetStats& stats, const std::string& split);

ReportTable label_table(const DatasetStats& stats);
ReportTable percentile_table(const DatasetStats& stats);
ReportTable grey_table(const DatasetStats& stats, std::array<std::uint64_t, 256> PixelSums::*levels);
ReportTable pair_table(const TrainVariety& train);

using SummaryOf = std::function<const Summary*(const Figures&)>;

/// Of every split: least, mean and greatest value; and the share of its frames in every step of the histogram.
std::vector<ReportTable> spread_tables(const DatasetStats& stats, const SummaryOf& summary_of);

}  // namespace ensonify
