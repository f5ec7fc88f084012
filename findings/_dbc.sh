# shellcheck shell=bash
# Sourced: a DBC file with what buses of engines have: an odd scale, an offset, a sign, Motorola order, an IEEE float.
write_dbc() {
	cat >"$1" <<'DBC'
VERSION ""
BU_: ECU
BO_ 2364540158 EEC1: 8 ECU
 SG_ EngineSpeed : 24|16@1+ (0.125,0) [0|8031.875] "rpm" ECU
 SG_ Torque : 16|8@1+ (1,-125) [-125|125] "%" ECU
 SG_ Trim : 40|8@1- (0.5,0) [-64|63.5] "deg" ECU
BO_ 300 SHAFT: 8 ECU
 SG_ ShaftTorque : 0|32@1- (1,0) [-100000|100000] "Nm" ECU
 SG_ Power : 39|16@0+ (0.1,-100) [0|0] "kW" ECU
SIG_VALTYPE_ 300 ShaftTorque : 1;
DBC
}
