"""What is heard: sound in the air, its levels, its sensation, sound files."""
