#include "block_factor.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace dismantle::statics {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlock = 6;
/// Fronts are joined where at most this share of the joined one is zero: fewer and larger products are faster.
constexpr double kZeros = 0.25;

Index at(std::size_t block) { return kBlock * static_cast<Index>(block); }

/// An order of elimination with little fill.
std::vector<std::size_t> order_of(const BlockMatrix& pattern) {
  const auto count = static_cast<int>(pattern.diagonal.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < count; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [a, b] : pattern.pairs) {
    entries.emplace_back(static_cast<int>(a), static_cast<int>(b), 1.0);
    entries.emplace_back(static_cast<int>(b), static_cast<int>(a), 1.0);
  }
  Eigen::SparseMatrix<double> graph(count, count);
  graph.setFromTriplets(entries.begin(), entries.end());
  Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> permutation;
  Eigen::AMDOrdering<int>()(graph, permutation);
  std::vector<std::size_t> order;
  for (int i = 0; i < count; ++i) order.push_back(static_cast<std::size_t>(permutation.indices()[i]));
  return order;
}

/// In place, the lower half: L with ones on its diagonal, which are not stored, and D. False: a pivot is zero.
bool factor_dense(MatrixXd& m, VectorXd& d) {
  const Index n = m.rows();
  d.resize(n);
  for (Index k = 0; k < n; ++k) {
    d[k] = m(k, k);
    if (!(std::abs(d[k]) > 0) || !std::isfinite(d[k])) return false;
    const Index rest = n - k - 1;
    for (Index j = k + 1; j < n; ++j) m.col(j).tail(n - j) -= m(j, k) / d[k] * m.col(k).tail(n - j);
    m.col(k).tail(rest) /= d[k];
  }
  return true;
}

}  // namespace

BlockMatrix::BlockMatrix(std::size_t rows, Pairs of) : pairs(std::move(of)), diagonal(rows) {
  ab.resize(pairs.size());
  ba.resize(pairs.size());
}

void BlockMatrix::set_zero() {
  for (auto* blocks : {&diagonal, &ab, &ba})
    for (Block& b : *blocks) b.setZero();
}

VectorXd BlockMatrix::times(const VectorXd& x) const {
  VectorXd y(x.size());
  for (std::size_t i = 0; i < diagonal.size(); ++i) y.segment<kBlock>(at(i)) = diagonal[i] * x.segment<kBlock>(at(i));
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const auto [a, b] = pairs[k];
    y.segment<kBlock>(at(a)) += ab[k] * x.segment<kBlock>(at(b));
    y.segment<kBlock>(at(b)) += ba[k] * x.segment<kBlock>(at(a));
  }
  return y;
}

BlockFactor::BlockFactor(const BlockMatrix& pattern) : order_(order_of(pattern)), position_(order_.size()) {
  for (std::size_t i = 0; i < order_.size(); ++i) position_[order_[i]] = i;
  entries_.resize(order_.size());
  for (std::size_t k = 0; k < pattern.pairs.size(); ++k) {
    const std::size_t a = position_[pattern.pairs[k].first], b = position_[pattern.pairs[k].second];
    entries_[std::min(a, b)].push_back({k, std::max(a, b), b > a});
  }
  find_fronts(pattern);
}

void BlockFactor::find_fronts(const BlockMatrix& pattern) {
  const std::size_t count = pattern.diagonal.size();
  // Rows below the diagonal in each column, with the fill: those of the matrix, and those of its children in the tree
  // of elimination.
  std::vector<std::vector<std::size_t>> rows(count), children(count);
  for (std::size_t c = 0; c < count; ++c) {
    for (const Entry& e : entries_[c]) rows[c].push_back(e.row);
    for (const std::size_t child : children[c])
      rows[c].insert(rows[c].end(), rows[child].begin() + 1, rows[child].end());
    std::sort(rows[c].begin(), rows[c].end());
    rows[c].erase(std::unique(rows[c].begin(), rows[c].end()), rows[c].end());
    if (!rows[c].empty()) children[rows[c].front()].push_back(c);
  }
  // A front goes on with the next column if that is its parent, and little is zero then.
  front_of_.resize(count);
  for (std::size_t c = 0; c < count; ++c) {
    Front* last = fronts_.empty() ? nullptr : &fronts_.back();
    if (last != nullptr && !last->rows.empty() && last->rows.front() == c) {
      const double columns = static_cast<double>(last->columns), own = static_cast<double>(last->rows.size()),
                   all = static_cast<double>(rows[c].size()) + 1, zeros = columns * (all - own);
      if (zeros <= kZeros * (columns + 1) * all) {
        last->rows = rows[c];
        ++last->columns;
        front_of_[c] = fronts_.size() - 1;
        continue;
      }
    }
    fronts_.push_back({c, 1, rows[c]});
    front_of_[c] = fronts_.size() - 1;
  }
  for (std::size_t f = 0; f < fronts_.size(); ++f) {
    const Front& front = fronts_[f];
    if (!front.rows.empty()) fronts_[front_of_[front.rows.front()]].children.push_back(f);
    const double own = static_cast<double>(at(front.columns)), below = static_cast<double>(at(front.rows.size()));
    work_ += own * own * own / 6 + own * own * below / 2 + own * below * below / 2;
  }
}

std::size_t BlockFactor::place_in(const Front& front, std::size_t row) const {
  if (row < front.first + front.columns) return row - front.first;
  const auto found = std::lower_bound(front.rows.begin(), front.rows.end(), row);
  return front.columns + static_cast<std::size_t>(found - front.rows.begin());
}

void BlockFactor::assemble(Front& front, const BlockMatrix& matrix, bool symmetric) {
  const Index own = at(front.columns), rest = at(front.rows.size());
  front.pivots.setZero(own, own);
  front.below.setZero(rest, own);
  front.update.setZero(rest, rest);
  if (!symmetric) front.right.setZero(own, rest);
  const auto add = [&](std::size_t row, std::size_t column, const auto& block) {
    const Index r = at(row), c = at(column);
    if (r < own && c < own)
      front.pivots.block<kBlock, kBlock>(r, c) += block;
    else if (c < own)
      front.below.block<kBlock, kBlock>(r - own, c) += block;
    else if (r < own)
      front.right.block<kBlock, kBlock>(r, c - own) += block;
    else
      front.update.block<kBlock, kBlock>(r - own, c - own) += block;
  };
  for (std::size_t k = 0; k < front.columns; ++k) {
    const std::size_t column = front.first + k;
    add(k, k, matrix.diagonal[order_[column]]);
    for (const Entry& e : entries_[column]) {
      const std::size_t row = place_in(front, e.row);
      const auto& above = e.swapped ? matrix.ab[e.pair] : matrix.ba[e.pair];  // (column, row)
      if (symmetric) {
        if (e.swapped)
          add(row, k, above.transpose());
        else
          add(row, k, matrix.ab[e.pair]);
        continue;
      }
      add(row, k, e.swapped ? matrix.ba[e.pair] : matrix.ab[e.pair]);
      add(k, row, above);
    }
  }
  std::vector<std::size_t> places;
  for (const std::size_t child : front.children) {
    const Front& from = fronts_[child];
    places.clear();
    for (const std::size_t row : from.rows) places.push_back(place_in(front, row));
    for (std::size_t c = 0; c < places.size(); ++c)
      for (std::size_t r = symmetric ? c : 0; r < places.size(); ++r)
        add(places[r], places[c], from.update.block<kBlock, kBlock>(at(r), at(c)));
  }
}

bool BlockFactor::eliminate_symmetric(Front& front) const {
  if (!factor_dense(front.pivots, front.diagonal)) return false;
  if (front.rows.empty()) return true;
  // below = L21 D; then L21.
  front.pivots.triangularView<Eigen::UnitLower>().transpose().solveInPlace<Eigen::OnTheRight>(front.below);
  const MatrixXd scaled = front.below;
  front.below = front.below * front.diagonal.cwiseInverse().asDiagonal();
  front.update.triangularView<Eigen::Lower>() -= scaled * front.below.transpose();
  return true;
}

bool BlockFactor::eliminate(Front& front) const {
  front.lu.compute(front.pivots);
  const auto pivots = front.lu.matrixLU().diagonal();
  if (!pivots.allFinite() || !(pivots.cwiseAbs().minCoeff() > 0)) return false;
  if (front.rows.empty()) return true;
  front.right = front.lu.permutationP() * front.right;
  front.lu.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(front.right);
  front.lu.matrixLU().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(front.below);
  front.update.noalias() -= front.below * front.right;
  return true;
}

bool BlockFactor::factorize_symmetric(const BlockMatrix& matrix) { return factorize(matrix, true); }

bool BlockFactor::factorize(const BlockMatrix& matrix) { return factorize(matrix, false); }

bool BlockFactor::factorize(const BlockMatrix& matrix, bool symmetric) {
  symmetric_ = symmetric;
  for (Front& front : fronts_) {
    assemble(front, matrix, symmetric);
    if (!(symmetric ? eliminate_symmetric(front) : eliminate(front))) return false;
  }
  return true;
}

VectorXd BlockFactor::solve(const VectorXd& right) const {
  VectorXd x(right.size());
  for (std::size_t k = 0; k < order_.size(); ++k) x.segment<kBlock>(at(k)) = right.segment<kBlock>(at(order_[k]));
  VectorXd rest;
  const auto gather = [&](const Front& front) {
    rest.resize(at(front.rows.size()));
    for (std::size_t k = 0; k < front.rows.size(); ++k)
      rest.segment<kBlock>(at(k)) = x.segment<kBlock>(at(front.rows[k]));
  };
  for (const Front& front : fronts_) {
    auto own = x.segment(at(front.first), at(front.columns));
    if (symmetric_)
      front.pivots.triangularView<Eigen::UnitLower>().solveInPlace(own);
    else {
      own = front.lu.permutationP() * VectorXd(own);
      front.lu.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(own);
    }
    rest.noalias() = front.below * own;
    for (std::size_t k = 0; k < front.rows.size(); ++k)
      x.segment<kBlock>(at(front.rows[k])) -= rest.segment<kBlock>(at(k));
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    auto own = x.segment(at(front->first), at(front->columns));
    gather(*front);
    if (symmetric_) {
      own = own.cwiseQuotient(front->diagonal);
      own.noalias() -= front->below.transpose() * rest;
      front->pivots.triangularView<Eigen::UnitLower>().transpose().solveInPlace(own);
    } else {
      own.noalias() -= front->right * rest;
      front->lu.matrixLU().triangularView<Eigen::Upper>().solveInPlace(own);
    }
  }
  VectorXd y(right.size());
  for (std::size_t k = 0; k < order_.size(); ++k) y.segment<kBlock>(at(order_[k])) = x.segment<kBlock>(at(k));
  return y;
}

}  // namespace dismantle::statics
