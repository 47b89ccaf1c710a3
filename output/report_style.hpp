#pragma once

#include <string_view>

namespace ensonify {

/// The style sheet of report pages: light, dark, narrow and printed.
std::string_view report_style();

}  // namespace ensonify
