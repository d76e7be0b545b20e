/// Does a pile stand?
#pragma once

#include <functional>
#include <string_view>

#include "dismantle/export.h"
#include "dismantle/statics/pile.h"

namespace dismantle::statics {

/// Answer about one pile.
enum class Verdict {
  stands,      ///< forces in equilibrium exist, and a small displacement creates them
  falls,       ///< no forces in equilibrium exist
  pressed_in,  ///< such forces exist, but nothing creates them: it stays only if it was pressed in
  uncertain,   ///< too close to the limit, or not found out
};

/// Name in files and messages.
DISMANTLE_API std::string_view to_string(Verdict verdict);

/// A verdict with its certificate.
struct Judgement {
  Verdict verdict = Verdict::uncertain;
  ContactForces forces{};  ///< stands, pressed_in: in equilibrium
  Motions displacement{};  ///< stands: creates the forces
  Motions motion{};        ///< falls: Farkas' motion. pressed_in: how it moves if it was not pressed in
  ContactForces others{};  ///< pressed_in: in equilibrium, too, with other pressures
  Motions slide{};         ///< pressed_in: Farkas' motion without friction
};

/// Judges a pile; every certificate has been checked by check_equilibrium(), check_created(), check_fall() or
/// check_pressed_in(). A pile without anything that can move stands. `near`: as for balance().
DISMANTLE_API Judgement judge(const Pile& pile, const std::function<bool()>& stop = {}, const Motions& near = {});

/// The same for forces alone: `stands` means that forces in equilibrium exist, whatever creates them. Some ten times
/// faster. The certificates are `forces` and `motion`; `displacement` gives the forces by spring_forces(). `near`: as
/// for balance().
DISMANTLE_API Judgement judge_forces(const Pile& pile, const std::function<bool()>& stop = {},
                                     const Motions& near = {});

/// Is a pile that forces balance (`by_forces`: what judge_forces() found) pressed in? False, too, if it is not found
/// out. Fast where nothing slides.
DISMANTLE_API bool is_pressed_in(const Pile& pile, const Judgement& by_forces, const std::function<bool()>& stop = {});

}  // namespace dismantle::statics
