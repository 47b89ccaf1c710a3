#pragma once

#include "ensonify/output/report_page.hpp"
#include "ensonify/reproduction/findings.hpp"

namespace ensonify {

/// The report of a run, in the paper's order: conclusions, what is missing, sonar, filters, times, maps, tank and few
/// pairs, then what goes beyond the paper.
ReportPage page_of(const Findings& findings);

/// Its sections. Each says so where it has nothing to show.
ReportSection sonar_section(const Findings& findings);
ReportSection filter_section(const Findings& findings);
ReportSection time_section(const Findings& findings);
ReportSection map_section(const Findings& findings);
ReportSection tank_section(const Findings& findings);
ReportSection beyond_section(const Findings& findings);

}  // namespace ensonify
