#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ensonify/evaluation/filter_report.hpp"
#include "ensonify/output/report_page.hpp"
#include "ensonify/reproduction/closed_loop.hpp"
#include "ensonify/reproduction/few_pairs.hpp"
#include "ensonify/reproduction/map_study.hpp"
#include "ensonify/reproduction/real_pings.hpp"
#include "ensonify/reproduction/sonar_pictures.hpp"
#include "ensonify/reproduction/studies.hpp"
#include "ensonify/reproduction/times.hpp"

namespace ensonify {

/// Everything that a run found. What is empty is named in `missing`.
struct Findings {
  std::string scale;
  std::vector<Missing> missing;
  std::vector<Contender> contenders;
  SonarPictures sonar;
  ReportSource paper_source, tank_source, realistic_source;
  std::optional<FilterReport> filters;
  ContactSheet frames;
  std::optional<MapFindings> maps_as_the_paper, maps;
  std::vector<FewPairsModel> few_pairs;
  std::optional<FilterReport> tank_masks;
  std::optional<MapFindings> tank_maps;
  std::optional<FilterReport> ghosts;
  std::vector<LoopRun> loops;
  std::optional<RealFindings> real;
  Times times;
};

}  // namespace ensonify
