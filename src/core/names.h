#pragma once
// "Did you mean …?"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tsubu {

/// The known name nearest to `name` by edit distance (with transpositions), if it is near enough to be a slip of the pen:
/// at most a third of the letters wrong. Ties go to the first known name.
std::optional<std::string> nearestName(std::string_view name, const std::vector<std::string>& known);

/// "a, b or c".
std::string listNames(const std::vector<std::string>& names);

}  // namespace tsubu
