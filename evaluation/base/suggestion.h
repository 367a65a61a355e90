// SPDX-License-Identifier: BSD-3-Clause
// What a sentence says that refuses a name: what was probably meant, and what there is.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace touchdown::evaluation {

/// Letters added, left out, replaced, or changed with their neighbour, that make one word of the other (Damerau and
/// Levenshtein; nothing is changed twice).
int EditDistance(std::string_view a, std::string_view b);

/// " (did you mean land?)": the nearest of `names`, the first of several. Nothing if none is near, or if `word` is one
/// of them. Of dotted names one part alone may differ, and is compared alone; those of the same group are asked before others.
std::string DidYouMean(std::string_view word, const std::vector<std::string>& names);

/// This, and "; <lead> a, b or c" with the names: a long list only where none is near.
std::string Instead(std::string_view word, const std::vector<std::string>& names,
                    const std::string& lead);

/// The sentence of a room below that refuses `word`: of one that ends in "; known: a, b" the list becomes Instead's. Another one
/// stays as it is.
std::string WithSuggestion(const std::string& sentence, std::string_view word,
                           const std::vector<std::string>& names);

}  // namespace touchdown::evaluation
