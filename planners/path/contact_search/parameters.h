/// Parameters of the contact_search path planner.
#pragma once

#include "dismantle/push_search/parameters.h"

namespace dismantle::contact_search {

struct Parameters : push::SearchParameters, push::ProposalParameters {
  bool proposals = true;
  bool twists = true;
  bool novelty = true;

  static void describe(Schema<Parameters>& s) {
    push::describe_search(s);
    s.add("proposals", &Parameters::proposals,
          {.doc =
               "When translating, push first along directions that the contacts allow, then along the axes, then along "
               "free directions while pressing against a wall. Off: the axes only."});
    s.add("twists", &Parameters::twists,
          {.doc = "When turning, first try the screw motions that the surfaces in contact allow. Off: the axes only."});
    s.add("novelty", &Parameters::novelty,
          {.doc = "First expand states that differ from the states expanded before. Off: first in, first out."});
    push::describe_proposals(s);
  }

  push::Tactics tactics() const {
    push::Tactics t;
    static_cast<push::SearchParameters&>(t) = *this;
    static_cast<push::ProposalParameters&>(t) = *this;
    t.own_axes = true;
    t.novelty = novelty;
    t.first_rank = 1;  // free directions and axes before screws
    t.rotation_lag = 1;
    if (proposals) t.translating.push_back(push::Stage::free);
    t.translating.push_back(push::Stage::axes);
    if (proposals) t.translating.push_back(push::Stage::leaning);
    if (twists) t.rotating = {push::Stage::twists, push::Stage::leaning};
    t.rotating.push_back(push::Stage::axes);
    if (diagonals) push::add_diagonals(t);
    return t;
  }
};

}  // namespace dismantle::contact_search
