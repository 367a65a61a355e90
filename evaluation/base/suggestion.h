// SPDX-License-Identifier: BSD-3-Clause
// Parts of a sentence that refuses a name: the name that was probably meant, and the known names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchdown::evaluation {

/// Number of edits that turn one word into the other: letters added, left out, replaced, or swapped with their
/// neighbour (Damerau and Levenshtein; nothing is changed twice).
int EditDistance(std::string_view a, std::string_view b);

/// " (did you mean land?)": the nearest of `names`, the first of several. Empty if none is near, or if `word` is one of
/// them. Of dotted names only one part may differ, and it alone is compared; names of the same group come first.
std::string DidYouMean(std::string_view word, const std::vector<std::string>& names);

/// This, and "; <lead> a, b or c" with the names: a long list only where none is near.
std::string Instead(std::string_view word, const std::vector<std::string>& names,
                    const std::string& lead);

/// The sentence of a lower room that refuses `word`. In one that ends in "; known: a, b" the list becomes Instead's.
/// Another one stays as it is.
std::string WithSuggestion(const std::string& sentence, std::string_view word,
                           const std::vector<std::string>& names);

}  // namespace touchdown::evaluation
