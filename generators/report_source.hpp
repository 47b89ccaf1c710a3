#pragma once

#include "ensonify/generators/dataset_reader.hpp"
#include "ensonify/output/report_page.hpp"

namespace ensonify {

/// What a dataset's manifest says of it: no path, no time.
ReportSource report_source(const Dataset& dataset);

}  // namespace ensonify
