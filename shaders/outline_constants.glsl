// SPDX-License-Identifier: MIT
// One specialization constant a number: GLSL has no arrays of them. Element i holds the ids CONST_OUTLINE + 8 i .. + 7.
#if REAL_IS_DOUBLE
#define ZERO 0.0lf
#else
#define ZERO 0.0
#endif
#define ONE_ELEMENT(at, n0, n1, n2, n3, n4, n5, n6, n7) \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 0) const Real n0 = ZERO; \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 1) const Real n1 = ZERO; \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 2) const Real n2 = ZERO; \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 3) const Real n3 = ZERO; \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 4) const Real n4 = ZERO; \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 5) const Real n5 = ZERO; \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 6) const Real n6 = ZERO; \
  layout(constant_id = CONST_OUTLINE + 8 * (at) + 7) const Real n7 = ZERO;
ONE_ELEMENT(0, E0_0, E0_1, E0_2, E0_3, E0_4, E0_5, E0_6, E0_7)
ONE_ELEMENT(1, E1_0, E1_1, E1_2, E1_3, E1_4, E1_5, E1_6, E1_7)
ONE_ELEMENT(2, E2_0, E2_1, E2_2, E2_3, E2_4, E2_5, E2_6, E2_7)
ONE_ELEMENT(3, E3_0, E3_1, E3_2, E3_3, E3_4, E3_5, E3_6, E3_7)
ONE_ELEMENT(4, E4_0, E4_1, E4_2, E4_3, E4_4, E4_5, E4_6, E4_7)
ONE_ELEMENT(5, E5_0, E5_1, E5_2, E5_3, E5_4, E5_5, E5_6, E5_7)
ONE_ELEMENT(6, E6_0, E6_1, E6_2, E6_3, E6_4, E6_5, E6_6, E6_7)
ONE_ELEMENT(7, E7_0, E7_1, E7_2, E7_3, E7_4, E7_5, E7_6, E7_7)
ONE_ELEMENT(8, E8_0, E8_1, E8_2, E8_3, E8_4, E8_5, E8_6, E8_7)
ONE_ELEMENT(9, E9_0, E9_1, E9_2, E9_3, E9_4, E9_5, E9_6, E9_7)
ONE_ELEMENT(10, E10_0, E10_1, E10_2, E10_3, E10_4, E10_5, E10_6, E10_7)
ONE_ELEMENT(11, E11_0, E11_1, E11_2, E11_3, E11_4, E11_5, E11_6, E11_7)
ONE_ELEMENT(12, E12_0, E12_1, E12_2, E12_3, E12_4, E12_5, E12_6, E12_7)
ONE_ELEMENT(13, E13_0, E13_1, E13_2, E13_3, E13_4, E13_5, E13_6, E13_7)
ONE_ELEMENT(14, E14_0, E14_1, E14_2, E14_3, E14_4, E14_5, E14_6, E14_7)
ONE_ELEMENT(15, E15_0, E15_1, E15_2, E15_3, E15_4, E15_5, E15_6, E15_7)
ONE_ELEMENT(16, E16_0, E16_1, E16_2, E16_3, E16_4, E16_5, E16_6, E16_7)
ONE_ELEMENT(17, E17_0, E17_1, E17_2, E17_3, E17_4, E17_5, E17_6, E17_7)
ONE_ELEMENT(18, E18_0, E18_1, E18_2, E18_3, E18_4, E18_5, E18_6, E18_7)
ONE_ELEMENT(19, E19_0, E19_1, E19_2, E19_3, E19_4, E19_5, E19_6, E19_7)
ONE_ELEMENT(20, E20_0, E20_1, E20_2, E20_3, E20_4, E20_5, E20_6, E20_7)
ONE_ELEMENT(21, E21_0, E21_1, E21_2, E21_3, E21_4, E21_5, E21_6, E21_7)
ONE_ELEMENT(22, E22_0, E22_1, E22_2, E22_3, E22_4, E22_5, E22_6, E22_7)
ONE_ELEMENT(23, E23_0, E23_1, E23_2, E23_3, E23_4, E23_5, E23_6, E23_7)
ONE_ELEMENT(24, E24_0, E24_1, E24_2, E24_3, E24_4, E24_5, E24_6, E24_7)
ONE_ELEMENT(25, E25_0, E25_1, E25_2, E25_3, E25_4, E25_5, E25_6, E25_7)
ONE_ELEMENT(26, E26_0, E26_1, E26_2, E26_3, E26_4, E26_5, E26_6, E26_7)
ONE_ELEMENT(27, E27_0, E27_1, E27_2, E27_3, E27_4, E27_5, E27_6, E27_7)
ONE_ELEMENT(28, E28_0, E28_1, E28_2, E28_3, E28_4, E28_5, E28_6, E28_7)
ONE_ELEMENT(29, E29_0, E29_1, E29_2, E29_3, E29_4, E29_5, E29_6, E29_7)
ONE_ELEMENT(30, E30_0, E30_1, E30_2, E30_3, E30_4, E30_5, E30_6, E30_7)
ONE_ELEMENT(31, E31_0, E31_1, E31_2, E31_3, E31_4, E31_5, E31_6, E31_7)
void load_outline() {
  if (OUTLINE_COUNT > 0) outline_copy[0] = make_element(Vec2(E0_0, E0_1), Vec2(E0_2, E0_3), Vec2(E0_4, E0_5), E0_6, E0_7);
  if (OUTLINE_COUNT > 1) outline_copy[1] = make_element(Vec2(E1_0, E1_1), Vec2(E1_2, E1_3), Vec2(E1_4, E1_5), E1_6, E1_7);
  if (OUTLINE_COUNT > 2) outline_copy[2] = make_element(Vec2(E2_0, E2_1), Vec2(E2_2, E2_3), Vec2(E2_4, E2_5), E2_6, E2_7);
  if (OUTLINE_COUNT > 3) outline_copy[3] = make_element(Vec2(E3_0, E3_1), Vec2(E3_2, E3_3), Vec2(E3_4, E3_5), E3_6, E3_7);
  if (OUTLINE_COUNT > 4) outline_copy[4] = make_element(Vec2(E4_0, E4_1), Vec2(E4_2, E4_3), Vec2(E4_4, E4_5), E4_6, E4_7);
  if (OUTLINE_COUNT > 5) outline_copy[5] = make_element(Vec2(E5_0, E5_1), Vec2(E5_2, E5_3), Vec2(E5_4, E5_5), E5_6, E5_7);
  if (OUTLINE_COUNT > 6) outline_copy[6] = make_element(Vec2(E6_0, E6_1), Vec2(E6_2, E6_3), Vec2(E6_4, E6_5), E6_6, E6_7);
  if (OUTLINE_COUNT > 7) outline_copy[7] = make_element(Vec2(E7_0, E7_1), Vec2(E7_2, E7_3), Vec2(E7_4, E7_5), E7_6, E7_7);
  if (OUTLINE_COUNT > 8) outline_copy[8] = make_element(Vec2(E8_0, E8_1), Vec2(E8_2, E8_3), Vec2(E8_4, E8_5), E8_6, E8_7);
  if (OUTLINE_COUNT > 9) outline_copy[9] = make_element(Vec2(E9_0, E9_1), Vec2(E9_2, E9_3), Vec2(E9_4, E9_5), E9_6, E9_7);
  if (OUTLINE_COUNT > 10) outline_copy[10] = make_element(Vec2(E10_0, E10_1), Vec2(E10_2, E10_3), Vec2(E10_4, E10_5), E10_6, E10_7);
  if (OUTLINE_COUNT > 11) outline_copy[11] = make_element(Vec2(E11_0, E11_1), Vec2(E11_2, E11_3), Vec2(E11_4, E11_5), E11_6, E11_7);
  if (OUTLINE_COUNT > 12) outline_copy[12] = make_element(Vec2(E12_0, E12_1), Vec2(E12_2, E12_3), Vec2(E12_4, E12_5), E12_6, E12_7);
  if (OUTLINE_COUNT > 13) outline_copy[13] = make_element(Vec2(E13_0, E13_1), Vec2(E13_2, E13_3), Vec2(E13_4, E13_5), E13_6, E13_7);
  if (OUTLINE_COUNT > 14) outline_copy[14] = make_element(Vec2(E14_0, E14_1), Vec2(E14_2, E14_3), Vec2(E14_4, E14_5), E14_6, E14_7);
  if (OUTLINE_COUNT > 15) outline_copy[15] = make_element(Vec2(E15_0, E15_1), Vec2(E15_2, E15_3), Vec2(E15_4, E15_5), E15_6, E15_7);
  if (OUTLINE_COUNT > 16) outline_copy[16] = make_element(Vec2(E16_0, E16_1), Vec2(E16_2, E16_3), Vec2(E16_4, E16_5), E16_6, E16_7);
  if (OUTLINE_COUNT > 17) outline_copy[17] = make_element(Vec2(E17_0, E17_1), Vec2(E17_2, E17_3), Vec2(E17_4, E17_5), E17_6, E17_7);
  if (OUTLINE_COUNT > 18) outline_copy[18] = make_element(Vec2(E18_0, E18_1), Vec2(E18_2, E18_3), Vec2(E18_4, E18_5), E18_6, E18_7);
  if (OUTLINE_COUNT > 19) outline_copy[19] = make_element(Vec2(E19_0, E19_1), Vec2(E19_2, E19_3), Vec2(E19_4, E19_5), E19_6, E19_7);
  if (OUTLINE_COUNT > 20) outline_copy[20] = make_element(Vec2(E20_0, E20_1), Vec2(E20_2, E20_3), Vec2(E20_4, E20_5), E20_6, E20_7);
  if (OUTLINE_COUNT > 21) outline_copy[21] = make_element(Vec2(E21_0, E21_1), Vec2(E21_2, E21_3), Vec2(E21_4, E21_5), E21_6, E21_7);
  if (OUTLINE_COUNT > 22) outline_copy[22] = make_element(Vec2(E22_0, E22_1), Vec2(E22_2, E22_3), Vec2(E22_4, E22_5), E22_6, E22_7);
  if (OUTLINE_COUNT > 23) outline_copy[23] = make_element(Vec2(E23_0, E23_1), Vec2(E23_2, E23_3), Vec2(E23_4, E23_5), E23_6, E23_7);
  if (OUTLINE_COUNT > 24) outline_copy[24] = make_element(Vec2(E24_0, E24_1), Vec2(E24_2, E24_3), Vec2(E24_4, E24_5), E24_6, E24_7);
  if (OUTLINE_COUNT > 25) outline_copy[25] = make_element(Vec2(E25_0, E25_1), Vec2(E25_2, E25_3), Vec2(E25_4, E25_5), E25_6, E25_7);
  if (OUTLINE_COUNT > 26) outline_copy[26] = make_element(Vec2(E26_0, E26_1), Vec2(E26_2, E26_3), Vec2(E26_4, E26_5), E26_6, E26_7);
  if (OUTLINE_COUNT > 27) outline_copy[27] = make_element(Vec2(E27_0, E27_1), Vec2(E27_2, E27_3), Vec2(E27_4, E27_5), E27_6, E27_7);
  if (OUTLINE_COUNT > 28) outline_copy[28] = make_element(Vec2(E28_0, E28_1), Vec2(E28_2, E28_3), Vec2(E28_4, E28_5), E28_6, E28_7);
  if (OUTLINE_COUNT > 29) outline_copy[29] = make_element(Vec2(E29_0, E29_1), Vec2(E29_2, E29_3), Vec2(E29_4, E29_5), E29_6, E29_7);
  if (OUTLINE_COUNT > 30) outline_copy[30] = make_element(Vec2(E30_0, E30_1), Vec2(E30_2, E30_3), Vec2(E30_4, E30_5), E30_6, E30_7);
  if (OUTLINE_COUNT > 31) outline_copy[31] = make_element(Vec2(E31_0, E31_1), Vec2(E31_2, E31_3), Vec2(E31_4, E31_5), E31_6, E31_7);
}
