#include "block_factor.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <random>

namespace dismantle::statics {
namespace {

using Block = BlockMatrix::Block;

/// Springs between bodies that are paired at random: two parts that do not touch, some pairs twice. All stand on
/// something.
BlockMatrix random_matrix(std::mt19937& random, std::size_t rows, std::size_t pairs) {
  std::uniform_real_distribution<double> unit(-1, 1);
  BlockMatrix::Pairs paired;
  for (std::size_t k = 0; k < pairs; ++k) {
    const std::size_t a = random() % rows, b = random() % rows;
    if (a != b && (a < rows / 3) == (b < rows / 3)) paired.emplace_back(a, b);
  }
  BlockMatrix matrix(rows, paired);
  matrix.set_zero();
  for (Block& d : matrix.diagonal) d = 0.01 * Block::Identity();
  for (std::size_t k = 0; k < paired.size(); ++k) {
    const Block half = Block::NullaryExpr([&] { return unit(random); }), whole = half * half.transpose();
    matrix.diagonal[paired[k].first] += whole;
    matrix.diagonal[paired[k].second] += whole;
    matrix.ab[k] = matrix.ba[k] = -whole;
  }
  return matrix;
}

Eigen::MatrixXd dense(const BlockMatrix& matrix) {
  const auto size = static_cast<Eigen::Index>(6 * matrix.diagonal.size());
  Eigen::MatrixXd all(size, size);
  for (Eigen::Index c = 0; c < size; ++c) all.col(c) = matrix.times(Eigen::VectorXd::Unit(size, c));
  return all;
}

TEST(BlockFactor, SolvesAsDenseFactorsDo) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 40; ++trial) {
    const std::size_t rows = 1 + random() % 25;
    BlockMatrix matrix = random_matrix(random, rows, random() % (3 * rows));
    const Eigen::VectorXd right = Eigen::VectorXd::LinSpaced(static_cast<Eigen::Index>(6 * rows), -1, 2);
    BlockFactor factor(matrix);
    for (const bool symmetric : {true, false, true}) {
      if (!symmetric)
        for (Block& b : matrix.ab) b(0, 1) += 0.05;
      if (symmetric) matrix.ab = matrix.ba;
      ASSERT_TRUE(symmetric ? factor.factorize_symmetric(matrix) : factor.factorize(matrix));
      const Eigen::VectorXd expected = dense(matrix).fullPivLu().solve(right), found = factor.solve(right);
      EXPECT_LT((found - expected).norm(), 1e-9 * expected.norm()) << trial;
    }
  }
}

TEST(BlockFactor, SaysThatAMatrixIsSingular) {
  BlockMatrix matrix(2, {{0, 1}});
  matrix.set_zero();
  matrix.diagonal[0].setIdentity();
  BlockFactor factor(matrix);
  EXPECT_FALSE(factor.factorize_symmetric(matrix));
  EXPECT_FALSE(factor.factorize(matrix));
}

TEST(BlockFactor, WorkOfAChainGrowsLikeItsLength) {
  const auto work = [](std::size_t rows) {
    BlockMatrix::Pairs pairs;
    for (std::size_t k = 1; k < rows; ++k) pairs.emplace_back(k - 1, k);
    return BlockFactor(BlockMatrix(rows, pairs)).work();
  };
  EXPECT_LT(work(400), 5 * work(100));
  EXPECT_GT(work(400), 3 * work(100));
}

}  // namespace
}  // namespace dismantle::statics
