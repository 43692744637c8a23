/** Portuguese titles of values, sections and parts of a scenario, by their English title. */
export const titles: Record<string, string> = {
  // Sections and parts
  Swarm: 'Enxame', Model: 'Modelo', Start: 'Posições iniciais', Arena: 'Arena', Controller: 'Controlador', Reference: 'Referência', Estimator: 'Estimador', Field: 'Campo',
  'Motility law': 'Lei de motilidade', Scale: 'Escala', Camera: 'Câmera', Microscope: 'Microscópio', Simulation: 'Simulação', Exclusion: 'Exclusão', Limits: 'Limites', Flow: 'Fluxo óptico',
  Record: 'Gravação', Rig: 'Bancada', Coil: 'Bobina', Segment: 'Segmento', Guard: 'Proteção', Driver: 'Acionamento', Channel: 'Canal', Source: 'Fonte', 'Step response': 'Resposta ao degrau',
  // Scenario and swarm
  Title: 'Título', Seed: 'Semente', Duration: 'Duração', 'Air exposure time': 'Tempo de exposição ao ar', 'Number of cells': 'Número de células', Polarity: 'Polaridade', 'Responsive fraction': 'Fração responsiva', Heading: 'Orientação',
  // Models
  Speed: 'Velocidade', 'Speed, standard deviation': 'Velocidade, desvio padrão', 'Speed max': 'Velocidade máxima', 'Noise amplitude': 'Amplitude do ruído', 'Maximum innate speed': 'Velocidade inata máxima',
  'Iterations per drawn velocity': 'Iterações por velocidade sorteada', 'Continuous speed': 'Velocidades reais', Earth: 'Campo da Terra', Moment: 'Momento magnético', 'Moment spread': 'Dispersão do momento', Radius: 'Raio',
  'Drag factor': 'Fator de arrasto', Viscosity: 'Viscosidade', Temperature: 'Temperatura', 'Rotational diffusion': 'Difusão rotacional', 'Translational diffusion': 'Difusão translacional', 'Motile fraction': 'Fração móvel',
  'Reversal rate': 'Taxa de reversão', 'Tumble rate': 'Taxa de tombos', 'Tumble, standard deviation': 'Tombo, desvio padrão',
  // Arena, start, reference
  Size: 'Tamanho', View: 'Vista', Centre: 'Centro', Depth: 'Profundidade', Visible: 'Visível', Direction: 'Direção', Positions: 'Posições', Scatter: 'Dispersão', Setpoint: 'Ponto de referência', Setpoints: 'Pontos de referência',
  Tolerance: 'Tolerância', 'Hold frames': 'Quadros de permanência', Timeout: 'Tempo limite', 'Wall alignment': 'Alinhamento à parede',
  // Controllers and estimators
  Gain: 'Ganho', 'Integral gain': 'Ganho integral', 'Integral time': 'Tempo integral', 'Max output': 'Comando máximo', 'Dead zone': 'Zona morta', 'Delay frames': 'Atraso em quadros', 'Frames per cell velocity': 'Quadros por velocidade de célula',
  Actuation: 'Atuação', 'Prediction time': 'Tempo de predição', 'Near distance': 'Distância próxima', 'Far distance': 'Distância distante', 'Fuzzy states': 'Estados fuzzy', 'Direction of the command': 'Direção do comando', Current: 'Corrente',
  'Maximum displacement of the zero': 'Deslocamento máximo do zero', 'Maximum number of groups': 'Número máximo de grupos', Count: 'Número', Separation: 'Separação', At: 'Instante',
  // Scale, camera, limits
  'Image scale': 'Escala da imagem', 'Duration of one iteration': 'Duração de uma iteração', 'Field unit': 'Unidade de campo', File: 'Arquivo', Rate: 'Taxa de quadros', Jitter: 'Variação do atraso', Sensor: 'Sensor', 'Max current': 'Corrente máxima',
  'Max slew': 'Variação máxima', 'Max frame age': 'Idade máxima do quadro', Step: 'Passo', Order: 'Ordem', 'Integer positions': 'Posições inteiras',
  // Microscope and record
  'Cell diameter': 'Diâmetro da célula', 'Cell length': 'Comprimento da célula', Contrast: 'Contraste', 'Exposure time': 'Tempo de exposição', 'Read noise': 'Ruído de leitura', Noise: 'Ruído', Background: 'Fundo', Mode: 'Modo', Level: 'Nível',
  Tracks: 'Trajetórias', 'Tracks every': 'Intervalo das trajetórias', Compress: 'Compactar', Video: 'Vídeo', 'Video every': 'Intervalo do vídeo', Lossless: 'Sem perdas', 'As seen': 'Como a câmera vê', Checkpoint: 'Ponto de retomada', Resolution: 'Resolução',
};
