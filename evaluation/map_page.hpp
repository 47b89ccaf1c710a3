#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ensonify/evaluation/map_report.hpp"
#include "ensonify/output/report_page.hpp"

namespace ensonify {

/// The scores of maps for a reader: at the best threshold, over all thresholds by model, by place; `pictures` of every
/// place from above.
ReportPage map_page(const MapReport& report, std::vector<std::pair<std::string, ContactSheet>> pictures,
                    const ReportSource& source);

}  // namespace ensonify
