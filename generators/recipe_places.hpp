#pragma once

#include <vector>

#include "ensonify/config/reader.hpp"
#include "ensonify/generators/recipe.hpp"

/// The places of a recipe's splits. All throw ConfigError at the place of the key that breaks the rule.
namespace ensonify {

std::vector<PlaceRef> read_places(Reader& split);

/// A scene that splits use with one layout each would give its places one name.
void tell_apart(std::vector<Split>& all);

/// No place in two splits, and no name of files for two places.
void refuse_shared_places(const Reader& splits, const std::vector<Split>& all);

}  // namespace ensonify
