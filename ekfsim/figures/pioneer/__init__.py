"""Document 001, the P3 robot with ultrasound and infrared."""
