/// Factors of sparse matrices of blocks of 6 x 6: one row of blocks for each body that can move.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cstddef>
#include <utility>
#include <vector>

namespace dismantle::statics {

/// A square matrix of blocks, with the same pattern above and below its diagonal.
struct BlockMatrix {
  using Block = Eigen::Matrix<double, 6, 6>;
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  /// With the blocks (a, b) and (b, a) of each pair; a and b differ, and a pair may be there more than once.
  BlockMatrix(std::size_t rows, Pairs pairs);
  void set_zero();
  Eigen::VectorXd times(const Eigen::VectorXd& x) const;

  Pairs pairs;
  std::vector<Block> diagonal, ab, ba;  // ab, ba: by pair
};

/// Multifrontal factors, without pivoting between rows of blocks: of a symmetric matrix that is positive definite, or
/// of any other whose diagonal is strong. The order of elimination depends on the pattern alone.
class BlockFactor {
 public:
  explicit BlockFactor(const BlockMatrix& pattern);

  /// L D L' of a symmetric matrix; `ba` is not read. False: a pivot is zero or not finite.
  bool factorize_symmetric(const BlockMatrix& matrix);
  /// L U. False: a pivot is zero or not finite.
  bool factorize(const BlockMatrix& matrix);
  Eigen::VectorXd solve(const Eigen::VectorXd& right) const;
  /// Multiplications of one factorize_symmetric(); factorize() takes twice as many.
  double work() const { return work_; }

 private:
  /// Columns that are eliminated together, and the rows below them that they change. Numbers are those of the order.
  struct Front {
    std::size_t first = 0, columns = 0;
    std::vector<std::size_t> rows{};
    std::vector<std::size_t> children{};
    // The pivots, what is below them and right of them, and what the parent has to add.
    Eigen::MatrixXd pivots{}, below{}, right{}, update{};
    Eigen::VectorXd diagonal{};  // symmetric: D
    Eigen::PartialPivLU<Eigen::MatrixXd> lu{};
  };
  struct Entry {  // a block of the matrix below the diagonal
    std::size_t pair, row;
    bool swapped;  // it is (b, a)
  };
  bool factorize(const BlockMatrix& matrix, bool symmetric);
  void find_fronts(const BlockMatrix& pattern);
  std::size_t place_in(const Front& front, std::size_t row) const;
  void assemble(Front& front, const BlockMatrix& matrix, bool symmetric);
  bool eliminate_symmetric(Front& front) const;
  bool eliminate(Front& front) const;

  std::vector<std::size_t> order_, position_;  // the k-th row that is eliminated; and its inverse
  std::vector<std::vector<Entry>> entries_;    // by column, in the order
  std::vector<Front> fronts_;
  std::vector<std::size_t> front_of_;  // by column
  double work_ = 0;
  bool symmetric_ = false;
};

}  // namespace dismantle::statics
