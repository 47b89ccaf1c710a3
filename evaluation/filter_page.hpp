#pragma once

#include "ensonify/evaluation/filter_report.hpp"
#include "ensonify/output/report_page.hpp"

namespace ensonify {

/// The scores of filters for a reader: all of them in one table, figures with intervals, masks over the threshold,
/// scenes, `frames` (the same frames through every filter), times.
ReportPage filter_page(const FilterReport& report, ContactSheet frames, const ReportSource& source);

}  // namespace ensonify
