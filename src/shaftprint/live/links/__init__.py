"""Links to what is on board: MQTT with plain blocks and Sparkplug B, Modbus, a CAN bus; lists of data channels."""
