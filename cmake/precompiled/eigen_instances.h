// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Eigen's decompositions and product kernels of the matrices that Palmar uses most: made once, in
// eigen_*.cpp beside this file, instead of in each of up to 35 sources. GCC leaves out of the other
// sources what isn't inline, which halves the time of those that solve or decompose. Part of the
// precompiled headers only: no source includes it, and each compiles to the same results without.

#include <Eigen/Dense>

// clang-format off
#if defined(EIGEN_VECTORIZE_SSE2) && !defined(EIGEN_VECTORIZE_AVX)
#define PALMAR_EIGEN_GEBP(EXTERN) \
  EXTERN template struct Eigen::internal::gebp_kernel<double, double, Eigen::Index, PALMAR_BLAS, 4, 4, false, false>;
#else  // other processors' kernels have other sizes
#define PALMAR_EIGEN_GEBP(EXTERN)
#endif
#define PALMAR_EIGEN_PRODUCTS(EXTERN) \
  PALMAR_EIGEN_GEBP(EXTERN) \
  EXTERN template struct Eigen::internal::gemm_pack_rhs<double, Eigen::Index, PALMAR_CONST_BLAS(0), 4, 0, false, false>; \
  EXTERN template struct Eigen::internal::gemm_pack_rhs<double, Eigen::Index, PALMAR_BLAS, 4, 0, false, true>; \
  PALMAR_GEMV(EXTERN, 0, 0, 0) \
  PALMAR_GEMV(EXTERN, 0, 1, 0) \
  PALMAR_GEMV(EXTERN, 1, 0, 0) \
  PALMAR_GEMV(EXTERN, 1, 1, 1) \
  EXTERN template struct Eigen::internal::selfadjoint_matrix_vector_product<double, Eigen::Index, 0, 1, false, false, 0>; \
  EXTERN template struct Eigen::internal::triangular_solve_vector<double, double, Eigen::Index, 1, 1, false, 0>; \
  EXTERN template struct Eigen::internal::triangular_solve_vector<double, double, Eigen::Index, 1, 2, false, 0>; \
  EXTERN template struct Eigen::internal::triangular_solve_vector<double, double, Eigen::Index, 1, 5, false, 0>; \
  EXTERN template struct Eigen::internal::triangular_solve_vector<double, double, Eigen::Index, 1, 6, false, 1>; \
  EXTERN template struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, 1, 1, false, 0, 0, 1>; \
  EXTERN template struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, 1, 2, false, 1, 0, 1>; \
  EXTERN template struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, 1, 5, false, 0, 0, 1>; \
  EXTERN template struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, 1, 6, false, 1, 0, 1>; \
  EXTERN template struct Eigen::internal::triangular_solve_matrix<double, Eigen::Index, 2, 2, false, 1, 0, 1>; \
  EXTERN template struct Eigen::internal::product_triangular_matrix_matrix<double, Eigen::Index, 1, true, 0, false, 0, false, 0, 1, 0>; \
  EXTERN template struct Eigen::internal::product_triangular_matrix_matrix<double, Eigen::Index, 2, true, 1, false, 0, false, 0, 1, 0>; \
  EXTERN template struct Eigen::internal::product_triangular_matrix_matrix<double, Eigen::Index, 5, true, 0, false, 0, false, 0, 1, 0>; \
  EXTERN template struct Eigen::internal::product_triangular_matrix_matrix<double, Eigen::Index, 6, true, 1, false, 0, false, 0, 1, 0>;

#define PALMAR_EIGEN_CHOLESKY(EXTERN) \
  EXTERN template Eigen::LLT<Eigen::MatrixXd>& Eigen::LLT<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&); \
  PALMAR_LDLT(EXTERN, Eigen::MatrixXd) \
  PALMAR_LDLT(EXTERN, Eigen::Matrix3d) \
  PALMAR_LDLT_SOLVE(EXTERN, Eigen::MatrixXd, Eigen::VectorXd, Eigen::VectorXd) \
  PALMAR_LDLT_SOLVE(EXTERN, Eigen::MatrixXd, Eigen::MatrixXd, Eigen::MatrixXd) \
  PALMAR_LDLT_SOLVE(EXTERN, Eigen::MatrixXd, Eigen::MatrixXd::IdentityReturnType, Eigen::MatrixXd) \
  PALMAR_LDLT_SOLVE(EXTERN, Eigen::Matrix3d, Eigen::Vector3d, Eigen::Vector3d)

#define PALMAR_EIGEN_ORTHOGONAL(EXTERN) \
  EXTERN template Eigen::PartialPivLU<Eigen::MatrixXd>& Eigen::PartialPivLU<Eigen::MatrixXd>::compute(const Eigen::EigenBase<Eigen::MatrixXd>&); \
  EXTERN template void Eigen::PartialPivLU<Eigen::MatrixXd>::compute(); \
  EXTERN template void Eigen::HouseholderQR<Eigen::MatrixXd>::computeInPlace(); \
  EXTERN template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::computeInPlace(); \
  EXTERN template void Eigen::ColPivHouseholderQR<Eigen::MatrixXd>::_solve_impl(const Eigen::VectorXd&, Eigen::VectorXd&) const; \
  PALMAR_EIGENVALUES(EXTERN, Eigen::MatrixXd) \
  PALMAR_EIGENVALUES(EXTERN, Eigen::Matrix2d) \
  PALMAR_EIGENVALUES(EXTERN, Eigen::Matrix3d)

#define PALMAR_BLAS Eigen::internal::blas_data_mapper<double, Eigen::Index, 0, 0, 1>
#define PALMAR_CONST_BLAS(ORDER) Eigen::internal::const_blas_data_mapper<double, Eigen::Index, ORDER>
#define PALMAR_GEMV(EXTERN, LEFT, RIGHT, VERSION) \
  EXTERN template struct Eigen::internal::general_matrix_vector_product<Eigen::Index, double, PALMAR_CONST_BLAS(LEFT), LEFT, false, double, PALMAR_CONST_BLAS(RIGHT), false, VERSION>;
#define PALMAR_LDLT(EXTERN, MATRIX) \
  EXTERN template Eigen::LDLT<MATRIX>& Eigen::LDLT<MATRIX>::compute(const Eigen::EigenBase<MATRIX>&);
#define PALMAR_LDLT_SOLVE(EXTERN, MATRIX, RIGHT, RESULT) \
  EXTERN template void Eigen::LDLT<MATRIX>::_solve_impl_transposed<true>(const RIGHT&, RESULT&) const;
#define PALMAR_EIGENVALUES(EXTERN, MATRIX) \
  EXTERN template Eigen::SelfAdjointEigenSolver<MATRIX>& Eigen::SelfAdjointEigenSolver<MATRIX>::compute(const Eigen::EigenBase<MATRIX>&, int);
// clang-format on

#ifndef PALMAR_MAKES_EIGEN_INSTANCES
PALMAR_EIGEN_PRODUCTS(extern)
PALMAR_EIGEN_CHOLESKY(extern)
PALMAR_EIGEN_ORTHOGONAL(extern)
#endif
