/// Equal steps that follow each other share a page: "6 × bolt".
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "content.h"

namespace dismantle {

/// Joins the steps of each run (see step_runs.h) that take one part or one product each, straight or by a screw motion,
/// while nothing else moves. What stands there is what stands before the first of them; the tools are those of the
/// first. `items`: by part, of bill_items(). @throws InputError when the plan has a part that the assembly lacks.
void join_equal_steps(std::vector<BookChapter>& chapters, const Plan& plan, const Assembly& assembly,
                      const std::vector<std::size_t>& items);

/// The facts of equal steps, each said once, in the order of their first step. Where several steps say the same of
/// different parts, the quoted names of parts become `name_of` them; where not all steps say it: "(2 / 6) ...".
/// Of the facts named `order`, only that of the first step is kept.
Facts facts_of_all(const std::vector<Facts>& each, const std::string& order,
                   const std::function<std::string(const std::string& part)>& name_of);

}  // namespace dismantle
