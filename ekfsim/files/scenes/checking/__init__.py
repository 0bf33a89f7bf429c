"""What the schemas cannot say of world, commands and study files: each mistake with its place."""
