#pragma once

#include <string>
#include <string_view>

namespace ensonify {

/// A drawing of gnuplot's as a part of an HTML page:
/// - only shapes and text are kept, of their attributes those of place and paint; no scripts, links, styles, fonts;
/// - ids start with `prefix`, so that those of several drawings in a page do not clash, and unused ones are gone;
/// - black is currentColor, every other colour var(--c-rrggbb, #rrggbb), so that the page's style decides;
/// - no background; a viewBox, so that it scales; `alt` says what it shows.
/// Throws DataError where `svg` is not well formed.
std::string inline_svg(std::string_view svg, const std::string& prefix, const std::string& alt);

}  // namespace ensonify
