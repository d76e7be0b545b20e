// The bill of materials and the steps of the assembly as CSV.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "dismantle/errors.h"
#include "dismantle/geometry/congruent_parts.h"
#include "dismantle/plan_io/bill_items.h"
#include "dismantle/plan_io/csv_text.h"
#include "dismantle/plan_io/exports.h"
#include "dismantle/plan_io/motion_words.h"
#include "dismantle/plan_io/step_numbers.h"
#include "dismantle/plan_io/text_columns.h"
#include "dismantle/plan_io/verdicts.h"

namespace dismantle {
namespace {

struct Item {
  std::string name;
  PartKind kind{};
  Aabb box{};  // input units
  std::vector<std::string> parts{};
  std::size_t count = 0;
};

std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ";") + name;
  return out;
}

class Items {
 public:
  Items(const Plan& plan, const Assembly& assembly) : plan_(plan), assembly_(assembly) {
    for (const Part& part : assembly.parts) ids_.emplace(part.name, part.id);
  }

  std::vector<Item> all() {
    std::vector<bool> done(assembly_.parts.size());
    for (const PlanComponent& component : plan_.assembly.components)
      if (component.kept) add_component(component, done);
    add_shapes(done);
    return std::move(items_);
  }

 private:
  PartId id_of(const std::string& name) const {
    const auto known = ids_.find(name);
    if (known == ids_.end())
      throw InputError(plan_.assembly.source,
                       fmt::format("the plan has a part '{}', which the assembly does not have", name));
    return known->second;
  }

  Aabb input_box(PartId id) const {
    Aabb box;
    const Aabb own = assembly_.parts[id].mesh->box();
    box.extend(assembly_.normalization.to_input(own.lo));
    box.extend(assembly_.normalization.to_input(own.hi));
    return box;
  }

  void add_component(const PlanComponent& component, std::vector<bool>& done) {
    const auto [it, fresh] = item_of_product_.try_emplace(component.product, items_.size());
    if (fresh) {
      Item& item = items_.emplace_back();
      item.name = component.product;
      for (const std::string& part : component.parts) item.box.extend(input_box(id_of(part)));
    }
    Item& item = items_[it->second];
    ++item.count;
    item.parts.push_back(component.name);
    for (const std::string& part : component.parts) done[id_of(part)] = true;
  }

  void add_shapes(const std::vector<bool>& done) {
    std::map<std::size_t, std::size_t> item_of_shape;
    const auto firsts = bill_items(plan_.assembly, assembly_, geometry::find_congruent(assembly_.parts));
    for (const PlanPart& part : plan_.assembly.parts) {
      const PartId id = id_of(part.name);
      if (done[id]) continue;
      const auto [it, fresh] = item_of_shape.try_emplace(firsts[id], items_.size());
      if (fresh) items_.push_back({part.name, part.kind.value_or(PartKind{}), input_box(id)});
      Item& item = items_[it->second];
      ++item.count;
      item.parts.push_back(part.name);
    }
  }

  const Plan& plan_;
  const Assembly& assembly_;
  std::map<std::string, PartId> ids_;
  std::map<std::string, std::size_t> item_of_product_;
  std::vector<Item> items_;
};

/// By disassembly step: the assembly steps that have to come before, which are those whose disassembly waits for it.
std::vector<std::string> waits_for(const Plan& plan) {
  const std::size_t steps = plan.disassembly.size();
  std::map<unsigned, std::size_t> index;
  for (std::size_t k = 0; k < steps; ++k) index.emplace(plan.disassembly[k].step, k);
  std::vector<std::string> out(steps);
  for (std::size_t k = steps; k-- > 0;) {
    if (plan.disassembly[k].layer == 0) return std::vector<std::string>(steps, "unknown");
    for (const unsigned before : plan.disassembly[k].after) {
      const auto known = index.find(before);
      if (known == index.end())
        throw InputError(plan.assembly.source,
                         fmt::format("step {} of the plan waits for step {}, which it does not have",
                                     plan.disassembly[k].step, before));
      std::string& list = out[known->second];
      list += fmt::format("{}{}", list.empty() ? "" : ";", step_number(plan, k, false));
    }
  }
  return out;
}

}  // namespace

std::string bom_csv(const Plan& plan, const Assembly& assembly, const InputFrame& frame) {
  const TextUnit unit = text_unit(frame, plan.assembly.box, "");
  std::string out = "item,count,name,kind,size,length_x,length_y,length_z,unit,parts\n";
  std::size_t number = 0;
  for (const Item& item : Items(plan, assembly).all()) {
    const Eigen::Vector3d size = unit.factor * item.box.size();
    out += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", ++number, item.count, csv_field(item.name),
                       csv_field(item.kind.kind), csv_field(item.kind.size), figure_text(size.x()),
                       figure_text(size.y()), figure_text(size.z()), unit.name, csv_field(listed(item.parts)));
  }
  return out;
}

std::string steps_csv(const Plan& plan, const InputFrame& frame, const GuidedDistances& guided) {
  const PlanAssembly& a = plan.assembly;
  const TextUnit unit = text_unit(frame, a.box, "");
  const double size = a.box.empty() ? 1 : std::max(a.box.size().maxCoeff(), 1e-300);
  const Eigen::Vector3d middle = a.box.empty() ? a.center : a.box.center();
  std::string out = "step,parts,motion,x,y,z,travel,turn_degrees,unit,waits_for,forced_depth,notes\n";
  const std::vector<std::string> waits = waits_for(plan);
  for (std::size_t k = plan.disassembly.size(); k-- > 0;) {
    const PlanStep& step = plan.disassembly[k];
    std::vector<std::string> parts, notes;
    for (const PlanMove& move : step.moves) parts.push_back(move.part);
    for (const PlanVerdict& verdict : step.checks)
      for (const StepNote& note : verdict.notes) notes.push_back(note.text);
    std::string motion, direction = ",,", travel, turn;
    if (!step.moves.empty()) {
      std::vector<Pose> poses = step.moves.front().poses;
      std::reverse(poses.begin(), poses.end());
      const MotionSummary summary = summarize_motion(poses, point_on_axis(poses, middle), stretch_tolerance(size));
      const std::optional<double> led = guided.empty() ? std::nullopt : guided.at(k);
      motion = travel_words(summary, led, {unit, frame.up, size, false}, frame.lies(step.up));
      if (!summary.stretches.empty()) {
        const Eigen::Vector3d last = summary.stretches.back().normalized();
        direction = fmt::format("{:.6f},{:.6f},{:.6f}", last.x() + 0.0, last.y() + 0.0, last.z() + 0.0);
      }
      travel = figure_text(unit.factor * stated_distance(summary, led, size));
      turn = figure_text(summary.turn * 180 / std::numbers::pi);
    }
    out += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", step_number(plan, k, false), csv_field(listed(parts)),
                       csv_field(motion), direction, travel, turn, unit.name, waits[k],
                       step.forced ? figure_text(unit.factor * step.forced->depth) : "", csv_field(listed(notes)));
  }
  return out;
}

}  // namespace dismantle
