#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ensonify/evaluation/image_scores.hpp"
#include "ensonify/evaluation/map_scores.hpp"
#include "ensonify/evaluation/mask_scores.hpp"
#include "ensonify/python/arrays.hpp"
#include "ensonify/python/unlocked.hpp"

namespace ensonify::python {
namespace {

template <typename A, typename B>
void require_same_size(const Image2<A>& a, const Image2<B>& b) {
  if (a.rows() == b.rows() && a.columns() == b.columns()) return;
  throw py::value_error(fmt::format("both images must have one size, not {} x {} and {} x {}", a.rows(), a.columns(),
                                    b.rows(), b.columns()));
}

py::dict score_image(const py::object& image, const py::object& clean) {
  const Image2<float> a = grey_from(image, "image").grey;
  const Image2<float> b = grey_from(clean, "clean").grey;
  require_same_size(a, b);
  for (const auto* levels : {&a, &b}) {
    if (!std::ranges::all_of(levels->pixels(), [](float v) { return std::isfinite(v); })) {
      throw py::value_error("image and clean must be finite");
    }
  }
  py::dict scores;
  scores["psnr_db"] = psnr_db(a, b);
  scores["ssim"] = ssim(a, b);
  scores["edge_preservation"] = edge_preservation(a, b);
  scores["equivalent_looks"] = equivalent_looks(a, b);
  return scores;
}

/// 0 or 255, from uint8 or bool.
Image2<std::uint8_t> mask_from(const py::object& object, const char* what) {
  const bool truth = py::isinstance<py::array_t<bool>>(object);
  Image2<std::uint8_t> mask;
  if (truth) {
    const auto array = require_array<bool>(object, what, 2);
    mask = Image2<std::uint8_t>(static_cast<int>(array.shape(0)), static_cast<int>(array.shape(1)));
    std::copy_n(array.data(), array.size(), mask.pixels().begin());
  } else {
    mask = image_from(require_array<std::uint8_t>(object, what, 2));
  }
  for (std::uint8_t& v : mask.pixels()) v = v != 0 ? 255 : 0;
  return mask;
}

py::dict score_mask(const py::object& mask, const py::object& truth) {
  const Image2<std::uint8_t> a = mask_from(mask, "mask");
  const Image2<std::uint8_t> b = mask_from(truth, "truth");
  require_same_size(a, b);
  Image2<float> levels(a.rows(), a.columns());
  std::ranges::copy(a.pixels(), levels.pixels().begin());
  const MaskCounts counts = count_levels(levels, b).at(255);
  py::dict scores;
  scores["precision"] = counts.precision();
  scores["recall"] = counts.recall();
  scores["iou"] = counts.iou();
  scores["f1"] = counts.f1();
  scores["true_positive"] = counts.true_positive;
  scores["false_positive"] = counts.false_positive;
  scores["false_negative"] = counts.false_negative;
  return scores;
}

py::dict score_map(const LogOddsMap& map, const OccupancyGrid& truth, int tolerance_cells) {
  MapCounts c;
  {
    const Unlocked unlocked;
    c = count_map(map, map_truth(truth, {tolerance_cells}));
  }
  py::dict scores;
  scores["fpr"] = c.fpr();
  scores["fnr"] = c.fnr();
  scores["coverage"] = c.coverage();
  scores["balanced_accuracy"] = c.balanced_accuracy();
  scores["brier"] = c.brier();
  scores["iou"] = c.iou();
  scores["precision"] = c.precision(0);
  scores["recall"] = c.recall(0);
  scores["f1"] = c.f1(0);
  scores["known"] = c.known();
  scores["observable"] = c.observable;
  return scores;
}

}  // namespace

void bind_evaluation(py::module_& m) {
  m.def(
      "score_image", &score_image, py::arg("image"), py::arg("clean"),
      "dict of psnr_db, ssim (Wang et al. 2004), edge_preservation and equivalent_looks against the noise-free twin;\n"
      "uint8, uint16 or float32 of one size.");
  m.def("score_mask", &score_mask, py::arg("mask"), py::arg("truth"),
        "dict of precision, recall, iou, f1 and counts of pixels; uint8 (not 0 is set) or bool of one size.");
  m.def(
      "score_map", &score_map, py::arg("map"), py::arg("truth"), py::arg("tolerance_cells") = 1,
      "dict of scores over the observable cells of the truth: fpr and fnr (free is positive, as in Lin et al. 2023),\n"
      "coverage, balanced_accuracy, brier, iou, and precision, recall and f1 of occupied cells within the tolerance.\n"
      "Raises ConfigError where the map's cells are not cells of the truth, or the truth has no `observable`.");
}

}  // namespace ensonify::python
